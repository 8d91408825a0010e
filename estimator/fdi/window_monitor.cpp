#include "estimator/fdi/window_monitor.h"

#include <algorithm>
#include <cmath>

namespace estimator::fdi {

void WindowMonitor::add(double u_V, std::uint8_t flag) noexcept {
  if (full()) {
    saturated_ -= flags_[next_] == kSaturated ? 1U : 0U;
    missing_ -= flags_[next_] == kMissing ? 1U : 0U;
  }
  u_V_[next_] = u_V;
  flags_[next_] = flag;
  saturated_ += flag == kSaturated ? 1U : 0U;
  missing_ += flag == kMissing ? 1U : 0U;
  next_ = next_ + 1 == flags_.size() ? 0 : next_ + 1;
  seen_ = std::min(seen_ + 1, flags_.size());
}

double WindowMonitor::u_rms_V() const noexcept {
  const std::size_t present = seen_ - missing_;
  double energy_V2 = 0.0;
  for (std::size_t i = 0; i < seen_; ++i) energy_V2 += u_V_[i] * u_V_[i];
  return present == 0 ? 0.0 : std::sqrt(energy_V2 / static_cast<double>(present));
}

void WindowMonitor::reset() noexcept {
  next_ = 0;
  seen_ = 0;
  saturated_ = 0;
  missing_ = 0;
}

void WindowMonitor::serialize(StateArchive& archive) {
  archive.fixed(u_V_);
  archive.fixed(flags_);
  for (std::size_t* count : {&next_, &seen_, &saturated_, &missing_}) archive.value(*count);
  if (next_ >= flags_.size() || seen_ > flags_.size()) archive.fail();
}

}  // namespace estimator::fdi
