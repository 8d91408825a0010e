// Slave actuators connected or not, needle valve open or 80 % closed: can the coefficients of
// ARX211 tell? They can when the ranges of one of them, over the periods of a minute, do not
// overlap. No mass, damping or needle figure is printed: those of the model file are assumed, and
// others around them are tried.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "estimator/batch.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/thesis_scenarios.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

constexpr int kCoefficients = 3;  // a1, a2, b1
constexpr std::array kNames = {"a1", "a2", "b1"};
/// A fifth of the opening: 25 times the pressure drop at the same flow.
constexpr double kClosed = 25.0;
constexpr const char* kNeedle = "coupled_slaves.needle_N_s2_per_m2";

struct Ranges {
  std::array<double, kCoefficients> low;
  std::array<double, kCoefficients> high;
};

Ranges ranges(const Scenario& scenario, std::uint64_t seed) {
  const ScenarioRecord record = run(with_rig_instruments(scenario), 60.0, seed);
  const auto periods =
      estimator::fit_periods(estimator::parse_structure("arx211"), record.u_V, record.y_m, kPeriod);
  Ranges out;
  out.low.fill(std::numeric_limits<double>::infinity());
  out.high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 1; i < periods.size(); ++i) {
    for (int c = 0; c < kCoefficients; ++c) {
      out.low[c] = std::min(out.low[c], periods[i].value[c]);
      out.high[c] = std::max(out.high[c], periods[i].value[c]);
    }
  }
  return out;
}

/// Names of the coefficients whose ranges do not overlap, "" for none.
std::string separating(const Ranges& a, const Ranges& b) {
  std::string out;
  for (int c = 0; c < kCoefficients; ++c) {
    if (a.high[c] < b.low[c] || b.high[c] < a.low[c])
      out += (out.empty() ? "" : ", ") + std::string(kNames[c]);
  }
  return out;
}

std::string verdict(const std::string& by) { return by.empty() ? "not separable" : "separable"; }

std::string shown(const Ranges& r) {
  return fmt::format("b1 {:.3e}..{:.3e}, a1 {:.4f}..{:.4f}", r.low[2], r.high[2], r.low[0],
                     r.high[0]);
}

/// In how many of the tried presets both verdicts come out as printed.
ReproducedRow around(const Ranges& alone, const Scenario& slaves) {
  int tried = 0;
  int held = 0;
  for (const double mass_kg : {5.0, 20.0, 100.0}) {
    for (const double damping : {2000.0, 5000.0, 10000.0}) {
      for (const double needle : {5.0, 20.0, 50.0, 100.0}) {
        Scenario scenario = with(slaves, "coupled_slaves.mass_kg", mass_kg);
        scenario = with(scenario, "coupled_slaves.damping_N_s_per_m", damping);
        const Ranges open = ranges(with(scenario, kNeedle, needle), 3);
        const Ranges closed = ranges(with(scenario, kNeedle, kClosed * needle), 4);
        ++tried;
        held += !separating(alone, open).empty() && separating(open, closed).empty() ? 1 : 0;
      }
    }
  }
  return judged(fmt::format("both verdicts hold, of {} presets around it", tried), {},
                static_cast<double>(held), "information",
                "5 to 100 kg, 2000 to 10000 N s/m, needle 5 to 100 N s2/m2 open, 25 times closed");
}

}  // namespace

std::vector<ReproducedRow> needle_valve() {
  const Scenario slaves = shipped("rig_2000psi_slaves");
  const double needle = *Scenario(slaves).model.value(kNeedle);
  const Ranges alone = ranges(shipped("rig_2000psi"), 1);
  const Ranges open = ranges(slaves, 2);
  const Ranges closed = ranges(with(slaves, kNeedle, kClosed * needle), 3);
  const std::string by = separating(alone, open);
  std::vector<ReproducedRow> rows;
  rows.push_back(judged("slave actuators connected or not", std::string("separable"), verdict(by),
                        "words",
                        "by " + by + "; without: " + shown(alone) + "; with: " + shown(open)));
  rows.push_back(judged("needle valve open or 80 % closed", std::string("not separable"),
                        verdict(separating(open, closed)), "words",
                        "open: " + shown(open) + "; closed: " + shown(closed)));
  rows.push_back(around(alone, slaves));
  return rows;
}

}  // namespace workbench::reproduce
