// Case III: either parameter may fail. That the two are not isolated is judged three ways: the
// range of b1 over d lies inside that over Ps; the bands of case I miss every d fault; the bands of
// case II give the same alarm for both. And a Ps that leaves the very trace of a d fault.
#include <fmt/format.h>

#include "workbench/reproduce/alarm_run.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/sweep.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

constexpr double kNormalPs_Pa = 1000.0 * kPa_per_psi;

std::string yes_no(bool yes) { return yes ? "yes" : "no"; }

/// Alarms some periods after a step at 6 s: "none", "above" or "below".
std::string alarm(const char* parameter, double value, double low, double high) {
  const auto found = run_with_alarms(with_fault(calibrated(), parameter, value, 6.0),
                                     watching_b1(period_estimator(), low, high), 14.0);
  if (found.changes.empty() || !found.changes.back().active) return "none";
  return found.changes.back().direction > 0 ? "above" : "below";
}

/// Supply pressure whose b1 is the given one, by bisection.
double pressure_with_b1(double b1) {
  double low = 0.9 * kNormalPs_Pa;
  double high = kNormalPs_Pa;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (fifth_period(with(calibrated(), "supply_pressure_Pa", middle)).b1 < b1 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ReproducedRow mistaken() {
  const Coefficients damped = fifth_period(with(calibrated(), "damping_N_s_per_m", 1250.0));
  const double pressure_Pa = pressure_with_b1(damped.b1);
  const Coefficients weak = fifth_period(with(calibrated(), "supply_pressure_Pa", pressure_Pa));
  return judged(
      "Ps at which b1 is that of d = 1250 N s/m, psi", {}, pressure_Pa / kPa_per_psi, "information",
      fmt::format("b1 {:.6e} and {:.6e}, a1 {:.6f} and {:.6f}: one point of the feature space",
                  weak.b1, damped.b1, weak.a1, damped.a1));
}

}  // namespace

std::vector<ReproducedRow> isolation() {
  const CoefficientRange pressure = b1_range(sweep("supply_pressure_Pa", kNormalPs_Pa));
  const CoefficientRange damping = b1_range(sweep("damping_N_s_per_m", 1000.0));
  std::vector<ReproducedRow> rows;
  rows.push_back(judged("b1 range of d lies inside that of Ps (both 50 to 150 %)",
                        std::string("yes"),
                        yes_no(damping.low > pressure.low && damping.high < pressure.high), "words",
                        fmt::format("{:.4e}..{:.4e} in {:.4e}..{:.4e}", damping.low, damping.high,
                                    pressure.low, pressure.high)));
  bool missed = true;
  for (const double d : {500.0, 750.0, 1250.0, 1500.0}) {
    missed = missed && alarm("damping_N_s_per_m", d, kCase1Low, kCase1High) == "none";
  }
  rows.push_back(judged("a d fault of up to +-50 % raises a case I alarm", std::string("no"),
                        yes_no(!missed), "words", "d 500, 750, 1250, 1500 N s/m"));
  const std::string of_damping = alarm("damping_N_s_per_m", 1250.0, kCase2Low, kCase2High);
  const std::string of_pressure =
      alarm("supply_pressure_Pa", 0.98 * kNormalPs_Pa, kCase2Low, kCase2High);
  rows.push_back(
      judged("case II bands, d 1250 N s/m: b1", std::string("below"), of_damping, "words"));
  rows.push_back(judged("case II bands, Ps 980 psi (within its normal class): b1", {}, of_pressure,
                        "information"));
  rows.push_back(judged("the two faults are isolated", std::string("no"),
                        yes_no(of_damping != of_pressure), "words",
                        "isolated = the alarms' names differ"));
  rows.push_back(mistaken());
  return rows;
}

}  // namespace workbench::reproduce
