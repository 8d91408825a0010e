// Which of two models is better on data that neither was fitted to?
//
//   d_b = mean over block b of (first^2 - second^2);   z = mean(d) / (sd(d) / sqrt(blocks))
//
// Blocks are long against the residuals' memory, so that their differences are independent; p is
// two-sided from Student's t with blocks - 1 degrees of freedom. Positive z: the second is better.
// Source: F. X. Diebold, R. S. Mariano, J. Business and Economic Statistics 13 (1995) 253.
#pragma once

#include <span>

namespace estimator::residual {

struct Comparison {
  double first_rms = 0.0;
  double second_rms = 0.0;
  double z = 0.0;
  double p = 1.0;  ///< NaN with fewer than three blocks
  int blocks = 0;
};

/// Residuals of the same samples under both models; NaN (in either) leaves a sample out: what was
/// fitted, or is missing. Blocks are stretches of `block` samples of the record (2 s, say); those
/// with less than half of their samples are left out.
[[nodiscard]] Comparison compare_residuals(std::span<const double> first,
                                           std::span<const double> second, int block);

/// The same for the blocks' energies in proportion, d_b = log(first energy / second energy): what
/// counts is in how many stretches the second is better and how steadily, not where errors are
/// largest. Blocks without any error in one of them are left out.
[[nodiscard]] Comparison compare_in_proportion(std::span<const double> first,
                                               std::span<const double> second, int block);

}  // namespace estimator::residual
