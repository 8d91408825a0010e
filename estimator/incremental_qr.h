// Householder factorisation of a tall matrix a chunk of rows at a time: [R; rows] -> R.
//
// The reflector of column j touches row j of R and the chunk only (R above is already triangular):
//
//   v = [1; x / (r_jj - beta)], beta = -sign(r_jj) |[r_jj; x]|, tau = (beta - r_jj) / beta,
//   for k > j:  w = tau (r_jk + v' x_k),  r_jk <- r_jk - w,  x_k <- x_k - w v
//
// The chunk stays in the first-level cache. Source: G. H. Golub, C. F. Van Loan, Matrix
// Computations, chapter 5; the triangle-on-rectangle form is LAPACK's tpqrt.
#pragma once

#include <array>

#include "estimator/givens_update.h"

namespace estimator {

class IncrementalQr {
 public:
  static constexpr int kChunk = 128;

  explicit IncrementalQr(int columns) noexcept : columns_(columns) {}

  /// Column j of the chunk to be filled: kChunk places, 16-byte aligned.
  double* column(int j) noexcept { return chunk_.data() + kChunk * j; }
  /// Absorbs the first `rows` rows of the chunk; its columns may be filled again afterwards.
  void absorb(int rows) noexcept;

  [[nodiscard]] int columns() const noexcept { return columns_; }
  /// R(i, j), j >= i.
  [[nodiscard]] double element(int i, int j) const noexcept {
    return r_[static_cast<std::size_t>(kMaxColumns * i + j)];
  }

 private:
  int columns_;
  std::array<double, static_cast<std::size_t>(kMaxColumns) * kMaxColumns> r_{};
  alignas(16) std::array<double, static_cast<std::size_t>(kMaxColumns) * kChunk> chunk_;
};

}  // namespace estimator
