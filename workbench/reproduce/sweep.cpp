#include "workbench/reproduce/sweep.h"

#include <algorithm>

#include "estimator/batch.h"

namespace workbench::reproduce {

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
