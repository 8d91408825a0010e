#include "daemon/rt/redundant_position_sensor.h"

#include <algorithm>

namespace monitor::rt {

const hal::Reading& RedundantPositionSensor::read(const hal::Tick& tick, const Clock& clock,
                                                  double t_s, double command_V,
                                                  bool controlling) noexcept {
  count_ = 1 + (spares_ == nullptr ? 0 : std::min(spares_->size(), kMaxSpareRods));
  std::array<control::RodReading, control::kMaxRods> rods;
  readings_[0] = rod_.read(tick);
  in_charge_ = readings_[0];
  if (in_charge_.end) return in_charge_;
  for (std::size_t i = 1; i < count_; ++i) readings_[i] = (*spares_)[i - 1].rod->read(tick);
  for (std::size_t i = 0; i < count_; ++i) {
    const hal::Reading& reading = readings_[i];
    const bool good = hal::trusted(reading.quality, reading.y_m);
    (i == 0 ? stats_.rod : stats_.spare_rods[i - 1]).count(good, reading.y_m);
    if (good) rods[i].y_m = reading.y_m;
    rods[i].called_stale = reading.t_ns == 0 && reading.quality == config::signals::Quality::stale;
    if (reading.t_ns != 0) {
      rods[i].age_s = static_cast<double>(clock.now_ns() - reading.t_ns) * 1e-9;
    }
  }
  voter_.update(std::span(rods).first(count_), t_s, command_V, controlling);
  if (voter_.changed()) since_tick_ = tick.index;
  publish(tick.index);
  const hal::Reading& chosen = readings_[voter_.in_charge()];
  in_charge_.y_m = chosen.y_m;
  in_charge_.t_ns = chosen.t_ns;
  in_charge_.quality = chosen.quality;
  return in_charge_;
}

void RedundantPositionSensor::publish(std::int64_t tick) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const control::RodFault fault = voter_.fault(i);
    if (stats_.rods[i].fault.load(std::memory_order_relaxed) == fault) continue;
    stats_.rods[i].since_tick.store(tick, std::memory_order_relaxed);
    stats_.rods[i].fault.store(fault, std::memory_order_relaxed);
  }
  stats_.rod_since_tick.store(since_tick_, std::memory_order_relaxed);
  stats_.rod_in_charge.store(static_cast<std::uint8_t>(voter_.in_charge()),
                             std::memory_order_relaxed);
}

void RedundantPositionSensor::fill(config::signals::Sample& sample) const noexcept {
  if (count_ < 2) return;
  sample.rod_count = static_cast<std::uint8_t>(count_);
  sample.rod_in_charge = static_cast<std::uint8_t>(voter_.in_charge());
  sample.rod_changed = voter_.changed();
  sample.rod_since = since_tick_;
  for (std::size_t i = 0; i < count_; ++i) {
    const bool good = hal::trusted(readings_[i].quality, readings_[i].y_m);
    sample.rod_m[i] = good ? readings_[i].y_m : hal::kMissing;
    sample.rod_quality[i] = good ? readings_[i].quality : config::signals::Quality::bad;
    sample.rod_fault[i] = static_cast<std::uint8_t>(voter_.fault(i));
  }
}

}  // namespace monitor::rt
