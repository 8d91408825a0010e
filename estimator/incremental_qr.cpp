#include "estimator/incremental_qr.h"

#include <algorithm>
#include <cmath>

namespace estimator {
namespace {

using Lanes [[gnu::vector_size(16), gnu::may_alias]] = double;

const Lanes* lanes(const double* at) noexcept { return reinterpret_cast<const Lanes*>(at); }
Lanes* lanes(double* at) noexcept { return reinterpret_cast<Lanes*>(at); }

double sum(Lanes v) noexcept { return v[0] + v[1]; }

/// x' x, with four sums so that additions need not wait for each other.
double square(const double* x, int pairs) noexcept {
  const Lanes* a = lanes(x);
  Lanes s0{}, s1{}, s2{}, s3{};
  for (int i = 0; i < pairs; i += 4) {
    s0 += a[i] * a[i];
    s1 += a[i + 1] * a[i + 1];
    s2 += a[i + 2] * a[i + 2];
    s3 += a[i + 3] * a[i + 3];
  }
  return sum((s0 + s1) + (s2 + s3));
}

/// Applies one reflector to `kCount` neighbouring columns, which share the loads of v. `scale`
/// turns x_j into v below its leading 1.
template <int kCount>
void reflect(const double* v, double scale, double tau, double* x, double* r, int pairs) noexcept {
  constexpr int kStride = IncrementalQr::kChunk / 2;
  const Lanes* a = lanes(v);
  Lanes* b = lanes(x);
  Lanes dot[2 * kCount] = {};
  for (int i = 0; i < pairs; i += 2) {
#pragma GCC unroll 8
    for (int c = 0; c < kCount; ++c) {
      dot[c] += a[i] * b[kStride * c + i];
      dot[kCount + c] += a[i + 1] * b[kStride * c + i + 1];
    }
  }
  double w[kCount];
#pragma GCC unroll 8
  for (int c = 0; c < kCount; ++c) {
    w[c] = tau * (r[c] + scale * sum(dot[c] + dot[kCount + c]));
    r[c] -= w[c];
    w[c] *= scale;
  }
  for (int i = 0; i < pairs; ++i) {
#pragma GCC unroll 8
    for (int c = 0; c < kCount; ++c) b[kStride * c + i] -= w[c] * a[i];
  }
}

}  // namespace

void IncrementalQr::absorb(int rows) noexcept {
  // Rows of zeros up to a multiple of the unrolled loops change nothing.
  const int whole = (rows + 7) / 8 * 8;
  for (int j = 0; j < columns_; ++j) std::fill(column(j) + rows, column(j) + whole, 0.0);
  const int pairs = whole / 2;
  for (int j = 0; j < columns_; ++j) {
    double* r = r_.data() + kMaxColumns * j;
    const double* v = column(j);
    const double below = square(v, pairs);
    if (below == 0.0) continue;
    const double diagonal = r[j];
    const double beta = -std::copysign(std::sqrt(diagonal * diagonal + below), diagonal);
    const double scale = 1.0 / (diagonal - beta);
    const double tau = (beta - diagonal) / beta;
    r[j] = beta;
    int k = j + 1;
    for (; k + 3 <= columns_; k += 3) reflect<3>(v, scale, tau, column(k), r + k, pairs);
    for (; k < columns_; ++k) reflect<1>(v, scale, tau, column(k), r + k, pairs);
  }
}

}  // namespace estimator
