#include "estimator/structures/stretch.h"

#include <algorithm>
#include <cmath>

namespace estimator::structures {

Stretches stretches_of(std::span<const double> u_V, std::span<const double> y_m,
                       std::span<const std::size_t> gaps, std::size_t begin, std::size_t end,
                       int least) {
  Stretches out;
  std::size_t from = begin;
  const auto close = [&](std::size_t to) {
    if (to >= from + static_cast<std::size_t>(least)) {
      out.push_back({u_V.subspan(from, to - from), y_m.subspan(from, to - from)});
    }
  };
  for (std::size_t t = begin; t < end; ++t) {
    if (!std::isfinite(u_V[t]) || !std::isfinite(y_m[t])) {
      close(t);
      from = t + 1;
    } else if (std::binary_search(gaps.begin(), gaps.end(), t)) {
      close(t);
      from = t;
    }
  }
  close(end);
  return out;
}

}  // namespace estimator::structures
