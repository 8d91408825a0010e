// The inner loop of the triangular factor: one row rotated into it without square roots.
//
// The factor of the augmented rows [psi y] is D^(1/2) U, D diagonal, U unit upper triangular. A row
// x of weight w goes in column by column:
//
//   d' = d + w x_j^2,  c = d / d',  s = w x_j / d',  w' = c w
//   u_k' = c u_k + s x_k,   x_k' = x_k - x_j u_k     for k > j
//
// This is a Givens rotation with its square roots kept in D. All weights stay positive, so the
// rotations are as stable as the plain ones. The form with one multiplication less,
// u_k + s x_k', is not used: it cancels when d is small against w x_j^2.
// Source: W. M. Gentleman, "Least squares computations by Givens transformations without square
// roots", J. Inst. Maths Applics 12 (1973).
#pragma once

#include "estimator/structure.h"

namespace estimator {

inline constexpr int kMaxColumns = kMaxCoefficients + 1;

/// Row length in memory: even, so that rows stay aligned for two lanes.
constexpr int padded(int columns) noexcept { return (columns + 1) & ~1; }

/// Rotates `row` (padded, destroyed) of `weight` into `factor`: D in the first padded(columns)
/// places, then the rows of U. Entries of `row` before `first` are zero. All 16-byte aligned.
using AbsorbRow = void (*)(double* factor, double* row, double weight, int first) noexcept;

/// The loop compiled for this number of columns, 1 to kMaxColumns.
[[nodiscard]] AbsorbRow absorb_row(int columns) noexcept;

}  // namespace estimator
