// Holds one alarm against a schedule of faults.
//
// The band's edges lie where the pressure is off by about 15 %. So that neither noise nor the
// edge's own place counts, the alarm may come from the moment at which it is off by 8 % (a step: at
// once), and must have come one `delay_s` after it is off by 20 %; it may go from the moment at
// which it is off by less than 20 % again, and must have gone delay_s + off_delay_s after 8 %.
// Between these it may do as it likes, with the fault's own direction; before and after it must
// stand still. An alarm that came kChatterCount times within kChatter_s may stay for kChatter_s
// longer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/soak/fault_plan.h"

namespace soak {

struct AlarmTimes {
  double delay_s;      ///< window, stride and what is left of a window when the fault comes
  double off_delay_s;  ///< the band's
};

class AlarmWatch {
 public:
  AlarmWatch(std::string name, const std::vector<Fault>& faults, AlarmTimes times);

  /// Time has come to t_s: what should have happened before?
  void advance(double t_s);
  /// The alarm came or went at t_s; direction -1 low, +1 high.
  void see(double t_s, bool active, int direction);

  [[nodiscard]] bool active() const noexcept { return active_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }
  [[nodiscard]] std::size_t comings() const noexcept { return comings_; }
  /// Longest time from the first moment at which it might have come, and gone.
  [[nodiscard]] double slowest_on_s() const noexcept { return slowest_on_s_; }
  [[nodiscard]] double slowest_off_s() const noexcept { return slowest_off_s_; }

 private:
  enum class Expected { off, coming, on, going };
  struct Phase {
    double from_s;
    Expected expected;
    int direction;
  };
  [[nodiscard]] Expected expected() const noexcept { return phases_[phase_].expected; }
  void enter(double t_s);
  void problem(double t_s, const std::string& what);

  std::string name_;
  std::vector<Phase> phases_;
  std::size_t phase_ = 0;
  bool active_ = false;
  std::vector<double> came_s_;  ///< the newest kChatterCount times
  bool chatters_ = false;
  double held_until_s_ = 0.0;  ///< 0: not held
  std::size_t comings_ = 0;
  double slowest_on_s_ = 0.0;
  double slowest_off_s_ = 0.0;
  std::vector<std::string> problems_;
};

}  // namespace soak
