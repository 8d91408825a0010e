// Cases I and II: one kind of fault, bands on b1, the alarms' coming and going.
#include <fmt/format.h>
#include <cmath>

#include "estimator/batch.h"
#include "workbench/reproduce/alarm_run.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/thesis_scenarios.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

/// Normal, a quarter more, normal, a quarter less.
Scenario schedule(const char* parameter, double normal) {
  Scenario scenario = with_fault(calibrated(), parameter, 1.25 * normal, 15.0);
  scenario = with_fault(scenario, parameter, normal, 30.0);
  return with_fault(scenario, parameter, 0.75 * normal, 45.0);
}

const char* name(int direction) {
  return direction > 0 ? "b1 above its band" : "b1 below its band";
}

/// b1 of the period that ends at t_s (or one sample before).
double b1_at(const AlarmRun& found, double t_s) {
  for (const CoefficientAt& estimate : found.estimates) {
    if (std::abs(estimate.t_s - t_s) < 0.0151) return estimate.b1;
  }
  return std::nan("");
}

/// `first` is the direction in which b1 goes first.
std::vector<ReproducedRow> timeline(const char* parameter, double normal, double low, double high,
                                    int first) {
  const auto found =
      run_with_alarms(schedule(parameter, normal), watching_b1(period_estimator(), low, high), 60.0,
                      1, Keep::estimates);
  std::vector<ReproducedRow> rows;
  for (const double t_s : {14.0, 16.0, 18.0, 32.0, 46.0, 48.0}) {
    rows.push_back(judged(fmt::format("b1 of the period that ends at {:.0f} s, m/V", t_s), {},
                          b1_at(found, t_s), "information"));
  }
  rows.push_back(judged(fmt::format("alarm on ({}), s", name(first)), 18.0, found.next(15.0, first),
                        "alarm time", "fault at 15 s"));
  rows.push_back(
      judged("alarm off, s", 32.0, found.next(18.0, 0), "alarm time", "normal again at 30 s"));
  rows.push_back(judged(fmt::format("alarm on ({}), s", name(-first)), 48.0,
                        found.next(45.0, -first), "alarm time", "fault at 45 s"));
  rows.push_back(judged("changes of the alarm in 60 s", 3.0,
                        static_cast<double>(found.changes.size()), "count",
                        "no others; the first period is warm-up without alarms"));
  rows.push_back(
      judged("delay of the first alarm, s", 3.0, found.next(15.0, first) - 15.0, "about 3 s"));
  return rows;
}

}  // namespace

std::vector<ReproducedRow> case_one() {
  return timeline("supply_pressure_Pa", 1000.0 * kPa_per_psi, kCase1Low, kCase1High, +1);
}

std::vector<ReproducedRow> case_two() {
  return timeline("damping_N_s_per_m", 1000.0, kCase2Low, kCase2High, -1);
}

namespace {

constexpr double kPrintedB1 = 1.9672e-4;

double fifth_period_b1(const Scenario& scenario) {
  const ScenarioRecord record = run(scenario, 10.0);
  const auto periods =
      estimator::fit_periods(estimator::parse_structure("arx111"), record.u_V, record.y_m, kPeriod);
  return periods.at(4).value[1];
}

}  // namespace

std::vector<ReproducedRow> printed_parameters() {
  return {judged("b1 of ARX111, parameters as printed, m/V", kPrintedB1,
                 fifth_period_b1(shipped("thesis")), "mean b1, as printed",
                 "outside every printed band: the printed valve constant 2.79e-5 m/V cannot be "
                 "the one used"),
          judged("b1 of ARX111, valve constant calibrated, m/V", kPrintedB1,
                 fifth_period_b1(calibrated()), "mean b1", "the valve constant was solved for it")};
}

}  // namespace workbench::reproduce
