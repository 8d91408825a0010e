#include "daemon/control/sensor_watch.h"

namespace monitor::control {

SensorWatch::SensorWatch(const std::vector<GuardConfig>& guards) {
  for (std::size_t i = 0; i < guards.size(); ++i) {
    if (watches_a_sensor(guards[i].which())) guards_.push_back({i, Guard(guards[i])});
  }
}

void SensorWatch::watch(const GuardInputs& inputs, double period_s) noexcept {
  for (Watched& each : guards_) {
    each.guard.watch(inputs, last_.dy_m(inputs), last_.dt_s(inputs), period_s);
  }
  last_.update(inputs);
}

void SensorWatch::start(double y_m) noexcept {
  for (Watched& each : guards_) each.guard.start(y_m);
}

RodFault SensorWatch::fault() const noexcept {
  for (const Watched& each : guards_) {
    if (!each.guard.active()) continue;
    switch (each.guard.kind()) {
      case GuardKind::stale:
        return RodFault::stale;
      case GuardKind::frozen:
        return RodFault::frozen;
      default:
        return RodFault::jump;
    }
  }
  return RodFault::none;
}

bool SensorWatch::still(double t_s) const noexcept {
  for (const Watched& each : guards_) {
    if (each.guard.kind() != GuardKind::frozen) continue;
    if (2.0 * each.guard.lasting_s(t_s) >= each.guard.time_s()) return true;
  }
  return false;
}

}  // namespace monitor::control
