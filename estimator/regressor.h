// Builds the rows of the linear regression y(t) = psi(t)' theta + e(t) from a stream of samples:
//
//   psi(t) = [-y(t-1) .. -y(t-n), u(t-k) .. u(t-k-m+1), (1)]
//
// Fixed memory; a gap or a missing value drops every row that would reach across it.
#pragma once

#include <array>
#include <cmath>

#include "estimator/structure.h"

namespace estimator {

class Regressor {
 public:
  explicit Regressor(const Structure& structure) noexcept : structure_(structure) {}

  /// Takes the next sample. Returns true when it completes a row, available in row() and
  /// target_m().
  /// A NaN or infinite value counts as a missing sample: returns false, and the history starts
  /// again.
  bool push(double u_V, double y_m) noexcept;

  /// Marks a gap: no row crosses it.
  void reset() noexcept { filled_ = 0; }

  [[nodiscard]] const Structure& structure() const noexcept { return structure_; }
  [[nodiscard]] int size() const noexcept { return structure_.size(); }
  /// psi in [0, size()), then the target, so that the augmented row is contiguous.
  [[nodiscard]] const double* row() const noexcept { return row_.data(); }
  [[nodiscard]] double target_m() const noexcept { return row_[structure_.size()]; }

 private:
  // Each history is written twice, half the length apart, so that the newest-first view is
  // contiguous without moving anything.
  static constexpr int kLength = 64;
  static_assert(kLength >= kMaxDelay + kMaxOrder);
  using History = std::array<double, 2 * kLength>;

  Structure structure_;
  int filled_ = 0;
  int newest_ = 0;
  History u_V_{};
  History minus_y_m_{};
  std::array<double, kMaxCoefficients + 1> row_{};
};

inline bool Regressor::push(double u_V, double y_m) noexcept {
  if (!std::isfinite(u_V) || !std::isfinite(y_m)) {
    reset();
    return false;
  }
  const bool ready = filled_ >= structure_.history();
  const int previous = newest_;
  newest_ = (newest_ + kLength - 1) % kLength;
  u_V_[newest_] = u_V_[newest_ + kLength] = u_V;
  minus_y_m_[newest_] = minus_y_m_[newest_ + kLength] = -y_m;
  if (!ready) {
    ++filled_;
    return false;
  }
  double* out = row_.data();
  const double* y = &minus_y_m_[previous];
  for (int i = 0; i < structure_.n; ++i) *out++ = y[i];
  const double* u = &u_V_[newest_] + structure_.k;
  for (int i = 0; i < structure_.m; ++i) *out++ = u[i];
  if (structure_.constant) *out++ = 1.0;
  *out = y_m;
  return true;
}

}  // namespace estimator
