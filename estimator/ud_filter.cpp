#include "estimator/ud_filter.h"

#include <array>
#include <cmath>
#include <utility>

namespace estimator {
namespace {

using Lanes [[gnu::vector_size(16), gnu::may_alias]] = double;

/// The sweep over columns from `first` on, given f and its alphas. Columns before it are unmoved.
template <int kSize>
void sweep(UdFactor& p, int first, const double* f, const double* v, const double* alpha,
           double scale, double* gain) noexcept {
  constexpr int kStride = padded(kSize);
  alignas(16) double inverse[kSize + 1];
  for (int j = first; j <= kSize; ++j) inverse[j] = 1.0 / alpha[j];
  for (int j = first; j < kSize; ++j) {
    p.d[j] *= alpha[j] * inverse[j + 1] * scale;
    const double down = -f[j] * inverse[j];
    const double up = v[j];
    auto* column = reinterpret_cast<Lanes*>(p.unit + kStride * j);
    auto* b = reinterpret_cast<Lanes*>(gain);
    for (int i = 0; i < (j + 1) / 2; ++i) {
      const Lanes old = column[i];
      column[i] = old + down * b[i];
      b[i] += up * old;
    }
    gain[j] = up;
  }
}

template <int kSize>
double measure(UdFactor& p, const double* psi, double r, double forgetting, double* gain) noexcept {
  constexpr int kStride = padded(kSize);
  double f[kSize];
  double v[kSize];
  double alpha[kSize + 1];
  alpha[0] = r;
  for (int j = 0; j < kSize; ++j) {
    const double* column = p.unit + kStride * j;
    double sum = psi[j];
    for (int i = 0; i < j; ++i) sum += column[i] * psi[i];
    f[j] = sum;
    v[j] = p.d[j] * sum;
    alpha[j + 1] = alpha[j] + sum * v[j];
  }
  if (!std::isfinite(alpha[kSize])) return alpha[kSize];
  for (int i = 0; i < kStride; ++i) gain[i] = 0.0;
  sweep<kSize>(p, 0, f, v, alpha, 1.0 / forgetting, gain);
  return alpha[kSize];
}

template <int kSize>
void add_information(UdFactor& p, int i, double information) noexcept {
  constexpr int kStride = padded(kSize);
  double f[kSize];
  double v[kSize];
  double alpha[kSize + 1];
  alignas(16) double gain[kStride] = {};
  alpha[i] = 1.0 / information;
  for (int j = i; j < kSize; ++j) {
    f[j] = j == i ? 1.0 : p.unit[kStride * j + i];
    v[j] = p.d[j] * f[j];
    alpha[j + 1] = alpha[j] + f[j] * v[j];
  }
  sweep<kSize>(p, i, f, v, alpha, 1.0, gain);
}

template <int... kIndex>
constexpr std::array<UdUpdate, sizeof...(kIndex)> table(
    std::integer_sequence<int, kIndex...> /*size less one*/) {
  return {UdUpdate{&measure<kIndex + 1>, &add_information<kIndex + 1>}...};
}

constexpr auto kTable = table(std::make_integer_sequence<int, kMaxCoefficients>{});

}  // namespace

const UdUpdate& ud_update(int size) noexcept { return kTable[size - 1]; }

}  // namespace estimator
