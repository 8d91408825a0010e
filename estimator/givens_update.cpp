#include "estimator/givens_update.h"

#include <array>
#include <utility>

namespace estimator {
namespace {

using Lanes [[gnu::vector_size(16), gnu::may_alias]] = double;

template <int kColumns>
void absorb(double* factor, double* row, double weight, int first) noexcept {
  constexpr int kStride = padded(kColumns);
  for (int j = first; j < kColumns; ++j) {
    const double x = row[j];
    if (x == 0.0) continue;
    const double weighted = weight * x;
    const double d = factor[j];
    const double sum = d + weighted * x;
    if (!(sum > 0.0)) {  // underflow, or not a number
      row[j] = 0.0;
      if (sum != sum) factor[j] = sum;
      continue;
    }
    const double inverse = 1.0 / sum;
    const double c = d * inverse;
    const double s = weighted * inverse;
    factor[j] = sum;
    weight *= c;
    auto* u = reinterpret_cast<Lanes*>(factor + kStride * (j + 1));
    auto* lanes = reinterpret_cast<Lanes*>(row);
    for (int k = j / 2; k < kStride / 2; ++k) {
      const Lanes old_u = u[k];
      const Lanes old_x = lanes[k];
      u[k] = c * old_u + s * old_x;
      lanes[k] = old_x - x * old_u;
    }
    // The diagonal of U is 1 by definition: rounding must not move it.
    factor[kStride * (j + 1) + j] = 1.0;
    row[j] = 0.0;
    if (weight == 0.0) return;
  }
}

template <int... kIndex>
constexpr std::array<AbsorbRow, sizeof...(kIndex)> absorb_table(
    std::integer_sequence<int, kIndex...> /*columns less one*/) {
  return {&absorb<kIndex + 1>...};
}

constexpr auto kAbsorbTable = absorb_table(std::make_integer_sequence<int, kMaxColumns>{});

}  // namespace

AbsorbRow absorb_row(int columns) noexcept { return kAbsorbTable[columns - 1]; }

}  // namespace estimator
