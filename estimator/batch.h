// Least squares over a whole record by orthogonal (Householder) factorisation of the regressor
// matrix: no normal equations, so near-singular data lose half as many digits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimator/estimate.h"

namespace estimator {

/// Fits `structure` to the samples. `u_V` and `y_m` have the same length; NaN marks a missing
/// value; `gaps` lists, in rising order, the index of the first sample after each gap.
[[nodiscard]] Estimate fit_batch(const Structure& structure, std::span<const double> u_V,
                                 std::span<const double> y_m,
                                 std::span<const std::size_t> gaps = {}, const Limits& limits = {});

/// One estimate per complete period of `period` samples. A later period takes its first rows'
/// history from the samples before it.
[[nodiscard]] std::vector<Estimate> fit_periods(const Structure& structure,
                                                std::span<const double> u_V,
                                                std::span<const double> y_m, std::size_t period,
                                                std::span<const std::size_t> gaps = {},
                                                const Limits& limits = {});

}  // namespace estimator
