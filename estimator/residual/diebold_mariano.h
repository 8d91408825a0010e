// Test which of two models is better on data that neither was fitted to.
//
//   d_b = log(sum of first^2 / sum of second^2) / samples, over block b;
//   z = mean(d) / (sd(d) / sqrt(blocks))
//
// The logarithm weighs every block alike: a model counts as better when it is steadily so, not
// where errors are largest.
// Blocks are long against the residuals' memory, so that their differences are independent; p is
// two-sided from Student's t with blocks - 1 degrees of freedom. Positive z: the second is better.
// Source: F. X. Diebold, R. S. Mariano, J. Business and Economic Statistics 13 (1995) 253.
#pragma once

#include <span>

namespace estimator::residual {

struct DieboldMarianoResult {
  double first_rms = 0.0;
  double second_rms = 0.0;
  double z = 0.0;
  double p = 1.0;  ///< NaN with fewer than three blocks
  int blocks = 0;
};

/// Residuals of the same samples under both models; NaN in either excludes a sample (fitted, or
/// missing). Blocks have `block` samples (2 s, say); blocks with less than half of their samples,
/// or without any error in one of the two, are excluded.
[[nodiscard]] DieboldMarianoResult diebold_mariano_test(std::span<const double> first,
                                                        std::span<const double> second, int block);

}  // namespace estimator::residual
