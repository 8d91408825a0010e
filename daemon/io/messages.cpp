#include "daemon/io/messages.h"

#include <algorithm>

namespace monitor::io {

void fill(spoolwatch::sample_t& message, const config::signals::Sample& sample,
          double sample_time_s) {
  message.tick = sample.tick;
  message.t_read_ns = sample.t_read_ns;
  message.t_write_ns = sample.t_write_ns;
  message.sample_time_s = sample_time_s;
  message.reference_m = sample.reference_m;
  message.y_m = sample.y_m;
  message.u_requested_V = sample.u_requested_V;
  message.u_applied_V = sample.u_applied_V;
  message.quality = static_cast<std::int8_t>(sample.quality);
  message.state = static_cast<std::int8_t>(sample.state);
  message.saturated = sample.saturated ? 1 : 0;
  message.gap = sample.gap;
}

void fill(spoolwatch::rods_t& message, const config::signals::Sample& sample) {
  message.tick = sample.tick;
  message.in_charge = static_cast<std::int8_t>(sample.rod_in_charge);
  message.changed = sample.rod_changed ? 1 : 0;
  message.since_tick = sample.rod_since;
  const std::size_t count = std::min<std::size_t>(sample.rod_count, config::signals::kMaxRods);
  message.count = static_cast<std::int32_t>(count);
  message.rod.resize(count);
  message.y_m.assign(sample.rod_m.begin(), sample.rod_m.begin() + count);
  message.quality.resize(count);
  message.fault.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    message.quality[i] = static_cast<std::int8_t>(sample.rod_quality[i]);
    message.fault[i] = static_cast<std::int8_t>(sample.rod_fault[i]);
  }
}

void fill(spoolwatch::pressures_t& message, const config::signals::Sample& sample) {
  message.tick = sample.tick;
  message.supply_Pa = sample.pressures.supply_Pa;
  message.in_Pa = sample.pressures.in_Pa;
  message.out_Pa = sample.pressures.out_Pa;
}

void fill(spoolwatch::estimate_t& message, const estimator::fdi::EstimateEvent& event) {
  message.source = event.source;
  message.tick = event.tick;
  message.valid = event.valid ? 1 : 0;
  message.reason = event.reason;
  message.condition = event.condition;
  const std::size_t size = event.size();
  message.size = static_cast<std::int32_t>(size);
  message.name.resize(size);
  message.value.resize(size);
  message.std_error.resize(size);
  message.low.resize(size);
  message.high.resize(size);
  std::size_t i = 0;
  for (const auto& value : event) {
    message.name[i] = value.name;
    message.value[i] = value.value;
    message.std_error[i] = value.std_error;
    message.low[i] = value.low;
    message.high[i] = value.high;
    ++i;
  }
}

void fill(spoolwatch::alarm_t& message, const estimator::fdi::Alarm& alarm, bool repeat) {
  message.source = alarm.source;
  message.name = alarm.name;
  message.severity = static_cast<std::int8_t>(alarm.severity);
  message.active = alarm.annunciated() ? 1 : 0;
  message.repeat = repeat ? 1 : 0;
  message.latched = alarm.latched ? 1 : 0;
  message.acknowledged = alarm.acknowledged ? 1 : 0;
  message.shelved = alarm.shelved ? 1 : 0;
  message.first_up = alarm.first_up ? 1 : 0;
  message.tick = alarm.tick;
  message.value = alarm.value;
  message.std_error = alarm.std_error;
  message.low = alarm.low;
  message.high = alarm.high;
  message.quantity = alarm.quantity;
  message.parameter = alarm.parameter;
  message.direction = alarm.direction;
  const bool known = !alarm.parameter.empty();
  message.parameter_direction =
      static_cast<std::int8_t>(!known                       ? 0
                               : alarm.falls_with_parameter ? -alarm.direction
                                                            : alarm.direction);
  message.confidence = alarm.confidence;
  message.group_size = static_cast<std::int32_t>(alarm.ambiguity_group.size());
  message.ambiguity_group = alarm.ambiguity_group;
  message.reason = alarm.reason;
  message.guidance = alarm.guidance;
}

}  // namespace monitor::io
