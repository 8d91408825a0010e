// The samples that a structure is fitted to: stretches of a record between gaps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace estimator::structures {

/// Consecutive samples without a missing value; both spans have the same length. Row t: y is read
/// before u is written.
struct Stretch {
  std::span<const double> u_V;
  std::span<const double> y_m;

  [[nodiscard]] int size() const { return static_cast<int>(y_m.size()); }
};

using Stretches = std::vector<Stretch>;

/// The stretches of samples [begin, end) that gaps (index of the first sample after each, rising)
/// and non-finite values leave; those shorter than `least` samples are left out.
[[nodiscard]] Stretches stretches_of(std::span<const double> u_V, std::span<const double> y_m,
                                     std::span<const std::size_t> gaps, std::size_t begin,
                                     std::size_t end, int least);

}  // namespace estimator::structures
