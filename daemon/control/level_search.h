// Searches a command that moves the rod at a speed within a band, one pulse per try: growing steps
// until two tries bracket the band, then bisection. Pure; no allocation.
#pragma once

#include <cmath>
#include <limits>

namespace monitor::control {

class LevelSearch {
 public:
  enum class State : unsigned char { searching, found, at_limit, given_up };

  LevelSearch() = default;
  /// The first try is `start_V`; no try exceeds +-limit_V.
  LevelSearch(double low_mps, double high_mps, double start_V, double limit_V) noexcept
      : low_mps_(low_mps),
        high_mps_(high_mps),
        level_V_(start_V),
        step_V_(start_V),
        limit_V_(limit_V) {}
  /// Starts between a level known to be too slow and one known to be too fast.
  static LevelSearch between(double low_mps, double high_mps, double slow_V,
                             double fast_V) noexcept {
    LevelSearch search(low_mps, high_mps, 0.5 * (slow_V + fast_V),
                       std::fmax(std::fabs(slow_V), std::fabs(fast_V)));
    search.slow_V_ = slow_V;
    search.fast_V_ = fast_V;
    return search;
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  /// The level to try next; at the end the level found.
  [[nodiscard]] double level_V() const noexcept { return level_V_; }
  /// The speed at the level found.
  [[nodiscard]] double speed_mps() const noexcept { return speed_mps_; }

  /// Reports the speed at level_V(); infinite: too fast to measure.
  void update(double speed_mps) noexcept {
    speed_mps_ = speed_mps;
    if (speed_mps >= low_mps_ && speed_mps <= high_mps_) {
      state_ = State::found;
      return;
    }
    if (++tries_ > kMostTries) {
      state_ = State::given_up;
      return;
    }
    const bool slow = speed_mps < low_mps_;
    if (slow && level_V_ >= limit_V_) {
      state_ = State::at_limit;
      return;
    }
    (slow ? slow_V_ : fast_V_) = level_V_;
    if (!std::isnan(slow_V_) && !std::isnan(fast_V_)) {
      level_V_ = 0.5 * (slow_V_ + fast_V_);
      return;
    }
    level_V_ = std::fmin(std::fmax(level_V_ + (slow ? step_V_ : -step_V_), -limit_V_), limit_V_);
    step_V_ *= kGrowth;
  }

 private:
  static constexpr int kMostTries = 24;
  static constexpr double kGrowth = 1.5;

  double low_mps_ = 0.0;
  double high_mps_ = 0.0;
  double level_V_ = 0.0;
  double step_V_ = 0.0;
  double limit_V_ = 0.0;
  double slow_V_ = std::numeric_limits<double>::quiet_NaN();
  double fast_V_ = std::numeric_limits<double>::quiet_NaN();
  double speed_mps_ = 0.0;
  int tries_ = 0;
  State state_ = State::searching;
};

}  // namespace monitor::control
