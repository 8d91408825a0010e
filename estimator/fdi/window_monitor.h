// Validity of a window of samples: enough command, few saturated and few missing samples. A ring of
// the last `length` samples; fixed memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/state_archive.h"

namespace estimator::fdi {

class WindowMonitor {
 public:
  explicit WindowMonitor(std::size_t length) : u_V_(length), flags_(length) {}

  void push(double u_V, bool saturated) noexcept { add(u_V, saturated ? kSaturated : 0); }
  void push_missing() noexcept { add(0.0, kMissing); }
  void reset() noexcept;
  void serialize(StateArchive& archive);

  /// True after `length` samples, missing ones included.
  [[nodiscard]] bool full() const noexcept { return seen_ >= flags_.size(); }
  [[nodiscard]] double saturated_share() const noexcept { return share(saturated_); }
  [[nodiscard]] double missing_share() const noexcept { return share(missing_); }
  /// Root mean square of u over the samples present, V.
  [[nodiscard]] double u_rms_V() const noexcept;

 private:
  static constexpr std::uint8_t kSaturated = 1;
  static constexpr std::uint8_t kMissing = 2;

  void add(double u_V, std::uint8_t flag) noexcept;
  [[nodiscard]] double share(std::size_t count) const noexcept {
    return static_cast<double>(count) / static_cast<double>(flags_.size());
  }

  std::vector<double> u_V_;
  std::vector<std::uint8_t> flags_;
  std::size_t next_ = 0;
  std::size_t seen_ = 0;
  std::size_t saturated_ = 0;
  std::size_t missing_ = 0;
};

}  // namespace estimator::fdi
