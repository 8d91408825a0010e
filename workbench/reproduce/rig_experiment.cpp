// The test stand at 2,000 psi, as a preset: ARX211 over whole periods, its bands, and the supply
// pressure going to 2,500 and then to 1,500 psi. How fast the real pressure moved is not printed.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "workbench/reproduce/alarm_run.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/spread.h"
#include "workbench/reproduce/thesis_scenarios.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

constexpr double kLow = 6.400e-5;
constexpr double kHigh = 6.700e-5;
constexpr double kRamp_s = 1.5;

AlarmRun pressure_test(double ramp_s) {
  Scenario scenario = with_rig_instruments(shipped("rig_2000psi"));
  const double normal_Pa = *scenario.model.value("supply_pressure_Pa");
  scenario = with_fault(scenario, "supply_pressure_Pa", 1.25 * normal_Pa, 13.0, ramp_s);
  scenario = with_fault(scenario, "supply_pressure_Pa", 0.75 * normal_Pa, 28.0, ramp_s);
  return run_with_alarms(scenario, watching_b1(period_estimator("arx211"), kLow, kHigh), 40.0);
}

ReproducedRow high_alarm(const AlarmRun& found, const std::string& when) {
  return judged(when + ": alarm (b1 above its band), s", 16.0, found.first(13.0, +1),
                "rig alarm time");
}
ReproducedRow low_alarm(const AlarmRun& found, const std::string& when) {
  return judged(when + ": alarm (b1 below its band), s", 30.0, found.first(28.0, -1),
                "rig alarm time");
}

void add_timeline(std::vector<ReproducedRow>& rows) {
  const AlarmRun found = pressure_test(kRamp_s);
  const std::string when = fmt::format("pressure ramps over {:.1f} s", kRamp_s);
  rows.push_back(high_alarm(found, when));
  rows.push_back(low_alarm(found, when));
  rows.push_back(judged(
      "changes of the alarm in 40 s", 2.0, static_cast<double>(found.changes.size()), "rig count",
      fmt::format("first at {:.3f} s: while the pressure moves, a1 and a2 bend and b1 is "
                  "low for a period",
                  found.changes.empty() ? NAN : found.changes.front().t_s)));
  std::string fitting;
  for (const double ramp_s : {0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0}) {
    const AlarmRun other = pressure_test(ramp_s);
    if (high_alarm(other, "").agrees == Agreement::yes &&
        low_alarm(other, "").agrees == Agreement::yes) {
      fitting += (fitting.empty() ? "" : ", ") + fmt::format("{:.2f}", ramp_s);
    }
  }
  rows.push_back(judged("ramps that give both printed times, s", {},
                        fitting.empty() ? std::string("none") : fitting, "information",
                        "tried: 0 (a step) to 3 s"));
}

void add_costs(std::vector<ReproducedRow>& rows, const ScenarioRecord& record) {
  struct Cost {
    const char* structure;
    double printed_m2;
  };
  const auto u_V = record.u(4 * kPeriod, kPeriod);
  const auto y_m = record.y(4 * kPeriod, kPeriod);
  for (const Cost& cost :
       {Cost{"arx111", 4.8595e-4}, Cost{"arx211", 3.7411e-4}, Cost{"arx311", 3.5075e-4},
        Cost{"arx411", 3.1446e-4}, Cost{"arx911", 2.59156e-4}}) {
    const auto structure = estimator::parse_structure(cost.structure);
    const auto estimate = estimator::fit_batch(structure, u_V, y_m);
    const auto simulated =
        estimator::free_run(structure, std::span(estimate.value).first(structure.size()), u_V, y_m);
    rows.push_back(judged(fmt::format("E of {}, m2", cost.structure), cost.printed_m2,
                          estimator::compare(y_m, simulated).cost_m2, "rig figure",
                          fmt::format("one sample out of step {:.4g}; exponents as inferred",
                                      estimator::compare(y_m, simulated, 0, 1).cost_m2)));
  }
}

void add_spread(std::vector<ReproducedRow>& rows, const ScenarioRecord& record) {
  const auto structure = estimator::parse_structure("arx211");
  const JudgedRun batch = judge_batch(structure, record);
  rows.push_back(judged("batch: J, m2", 0.0090, batch.cost_m2, "rig figure"));
  rows.push_back(judged("batch: mean b1, m/V", 6.5220e-5, batch.b1.mean, "rig b1"));
  rows.push_back(
      judged("batch: greatest offset of b1, m/V", 4.4956e-7, batch.b1.offset, "rig figure"));
  rows.push_back(
      judged("batch: variance of b1, (m/V)2", 2.2573e-14, batch.b1.variance, "rig figure"));
  const double forgetting = 0.998;
  const JudgedRun recursive = judge_recursive(structure, record, forgetting, true);
  const std::string name = fmt::format("recursive, forgetting {:.3f} (assumed)", forgetting);
  rows.push_back(judged(name + ": J, m2", 3.9927e-4, recursive.cost_m2, "rig figure"));
  rows.push_back(judged(name + ": mean b1, m/V", 6.4924e-5, recursive.b1.mean, "rig figure"));
  rows.push_back(
      judged(name + ": greatest offset of b1, m/V", 5.7642e-6, recursive.b1.offset, "rig figure"));
  rows.push_back(
      judged(name + ": variance of b1, (m/V)2", 2.1453e-12, recursive.b1.variance, "rig figure"));
}

double mean_b1(double pressure_factor) {
  Scenario scenario = with_rig_instruments(shipped("rig_2000psi"));
  *scenario.model.value("supply_pressure_Pa") *= pressure_factor;
  return judge_batch(estimator::parse_structure("arx211"), run(scenario, 60.0)).b1.mean;
}

}  // namespace

std::vector<ReproducedRow> rig_experiment() {
  std::vector<ReproducedRow> rows;
  const ScenarioRecord record = run(with_rig_instruments(shipped("rig_2000psi")), 60.0);
  add_costs(rows, record);
  add_spread(rows, record);
  const double normal = mean_b1(1.0);
  rows.push_back(judged("b1 for Ps +10 %, change in %", 5.0, 100.0 * (mean_b1(1.1) / normal - 1.0),
                        "rig, about 5 %", "friction, encoder and noise assumed"));
  rows.push_back(judged("b1 for Ps -10 %, change in %", -5.0, 100.0 * (mean_b1(0.9) / normal - 1.0),
                        "rig, about 5 %"));
  add_timeline(rows);
  return rows;
}

}  // namespace workbench::reproduce
