// Coefficients of ARX111 at constant conditions, over a range of one physical parameter.
#pragma once

#include <cstddef>
#include <vector>

#include "workbench/reproduce/thesis_scenarios.h"

namespace workbench::reproduce {

struct Coefficients {
  double a1;
  double b1;  ///< m/V
};

/// Least squares over the fifth period.
[[nodiscard]] Coefficients fifth_period(const Scenario& scenario);

/// 0.5, 0.6, ... 1.5 times the normal value, on the calibrated model.
[[nodiscard]] std::vector<Coefficients> sweep(const char* parameter, double normal);
/// Position of the normal value in a sweep.
inline constexpr std::size_t kNormal = 5;

struct CoefficientRange {
  double low;
  double high;
};
[[nodiscard]] CoefficientRange b1_range(const std::vector<Coefficients>& swept);

}  // namespace workbench::reproduce
