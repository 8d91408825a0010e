// The smallest size on a ladder that is detected often enough, for one method.
//
// Binary search: detection is taken to grow with the size. A rung is left as soon as it cannot be
// passed any more. What was found does not depend on which other methods are looked at.
#pragma once

#include <cstddef>
#include <optional>

namespace workbench::scorecard {

class LadderSearch {
 public:
  explicit LadderSearch(std::size_t rungs) : first_(0), end_(rungs), rungs_(rungs) {}

  /// The rung to be tried next; none when it is over.
  [[nodiscard]] std::optional<std::size_t> next() const {
    if (first_ >= end_) return std::nullopt;
    return first_ + (end_ - first_) / 2;
  }
  void tell(bool passed) {
    const std::size_t rung = *next();
    (passed ? end_ : first_) = passed ? rung : rung + 1;
  }
  /// The smallest rung that passed; none when not even the largest did.
  [[nodiscard]] std::optional<std::size_t> smallest() const {
    if (first_ < rungs_ && !next()) return first_;
    return std::nullopt;
  }

 private:
  std::size_t first_;  ///< all before it have failed
  std::size_t end_;    ///< it and all after it have passed
  std::size_t rungs_;
};

/// True when a rung of n trials is decided: passed with `share` of n detected.
[[nodiscard]] inline std::optional<bool> decided(std::size_t detected, std::size_t tried,
                                                 std::size_t n, double share) {
  constexpr double kRounding = 1e-9;
  const double needed = share * static_cast<double>(n) - kRounding;
  if (static_cast<double>(detected) >= needed) return true;
  if (static_cast<double>(detected + n - tried) < needed) return false;
  return std::nullopt;
}

}  // namespace workbench::scorecard
