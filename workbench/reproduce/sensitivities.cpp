// Sensitivity of the coefficients of ARX111 to supply pressure and damping: +-10 %, and from half
// to one and a half of the normal value. Each figure is of the fifth period at constant conditions.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/batch.h"
#include "workbench/reproduce/alarm_run.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/sweep.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

double percent(double value, double of) { return 100.0 * (value / of - 1.0); }

/// Greatest change of a1 within the entries [from, to] of a sweep, %.
double a1_change_percent(const std::vector<Coefficients>& swept, std::size_t from, std::size_t to) {
  double worst = 0.0;
  for (std::size_t i = from; i <= to; ++i) {
    const double change = percent(swept[i].a1, swept[kNormal].a1);
    if (std::abs(change) > std::abs(worst)) worst = change;
  }
  return worst;
}

}  // namespace

std::vector<ReproducedRow> pressure_sensitivity() {
  const auto swept = sweep("supply_pressure_Pa", 1000.0 * kPa_per_psi);
  const double normal = swept[kNormal].b1;
  const CoefficientRange range = b1_range(swept);
  return {judged("b1 for Ps +10 %, change in %", 5.0, percent(swept[kNormal + 1].b1, normal),
                 "about +5 %"),
          judged("b1 for Ps -10 %, change in %", -5.0, percent(swept[kNormal - 1].b1, normal),
                 "about -5 %"),
          judged("a1 for Ps +-10 %, greatest change in %", std::string("under 0.01"),
                 a1_change_percent(swept, kNormal - 1, kNormal + 1), "under 0.01 %"),
          judged("a1 for Ps +-50 %, greatest change in %", std::string("under 0.01"),
                 a1_change_percent(swept, 0, swept.size() - 1), "under 0.01 %"),
          judged("lowest b1, Ps 500 to 1500 psi, m/V", 1.30e-4, range.low, "range over Ps",
                 "printed bounds are wider than the square root of the pressure ratio"),
          judged("highest b1, Ps 500 to 1500 psi, m/V", 2.50e-4, range.high, "range over Ps"),
          judged("b1 for Ps 900 to 1100 psi lies within the case I bands", std::string("yes"),
                 std::string(swept[kNormal - 1].b1 > kCase1Low && swept[kNormal + 1].b1 < kCase1High
                                 ? "yes"
                                 : "no"),
                 "words",
                 fmt::format("{:.4e} to {:.4e}", swept[kNormal - 1].b1, swept[kNormal + 1].b1))};
}

std::vector<ReproducedRow> damping_sensitivity() {
  const auto swept = sweep("damping_N_s_per_m", 1000.0);
  const double normal = swept[kNormal].b1;
  const CoefficientRange range = b1_range(swept);
  return {judged("b1 for d +10 %, change in %", -0.07, percent(swept[kNormal + 1].b1, normal),
                 "about -0.07 %"),
          judged("b1 for d -10 %, change in %", 0.07, percent(swept[kNormal - 1].b1, normal),
                 "about +0.07 %"),
          judged("a1 for d +-10 %, greatest change in %", std::string("under 0.01"),
                 a1_change_percent(swept, kNormal - 1, kNormal + 1), "under 0.01 %"),
          judged("lowest b1, d 500 to 1500 N s/m, m/V", 1.9550e-4, range.low, "range over d",
                 "five times the printed 0.07 % is 0.35 %: the printed bounds are 0.6 % away"),
          judged("highest b1, d 500 to 1500 N s/m, m/V", 1.9790e-4, range.high, "range over d"),
          judged("b1 for d 900 to 1100 N s/m lies within the case II bands", std::string("yes"),
                 std::string(swept[kNormal + 1].b1 > kCase2Low && swept[kNormal - 1].b1 < kCase2High
                                 ? "yes"
                                 : "no"),
                 "words",
                 fmt::format("{:.5e} to {:.5e}", swept[kNormal + 1].b1, swept[kNormal - 1].b1))};
}

Coefficients fifth_period(const Scenario& scenario) {
  const ScenarioRecord record = run(scenario, 10.0);
  const auto periods =
      estimator::fit_periods(estimator::parse_structure("arx111"), record.u_V, record.y_m, kPeriod);
  return {periods.at(4).value[0], periods.at(4).value[1]};
}

std::vector<Coefficients> sweep(const char* parameter, double normal) {
  std::vector<Coefficients> out;
  for (int i = 5; i <= 15; ++i) {
    out.push_back(fifth_period(with(calibrated(), parameter, 0.1 * i * normal)));
  }
  return out;
}

CoefficientRange b1_range(const std::vector<Coefficients>& swept) {
  const auto [low, high] =
      std::minmax_element(swept.begin(), swept.end(),
                          [](const Coefficients& a, const Coefficients& b) { return a.b1 < b.b1; });
  return {low->b1, high->b1};
}

}  // namespace workbench::reproduce
