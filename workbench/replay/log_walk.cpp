#include "workbench/replay/log_walk.h"

#include <algorithm>
#include <lcm/lcm-cpp.hpp>

#include "config/messages/decode.h"
#include "config/record/event_reader.h"
#include "config/schema/error.h"

namespace workbench::replay {
namespace {

constexpr const char* kSample = "_SAMPLE";

template <class Message>
Message decoded(const lcm::LogEvent& event, const std::string& file) {
  Message message{};
  if (!config::messages::decode(message, event.data, event.datalen)) {
    throw config::schema::bad_data(
        file + ": event " + std::to_string(event.eventnum),
        "on " + event.channel + " is of another type",
        std::string("spoolwatch::") + Message::getTypeName() + " in this version's layout");
  }
  return message;
}

config::signals::Quality quality_of(std::int8_t quality) noexcept {
  const bool known = quality >= 0 && quality <= 3;
  return known ? static_cast<config::signals::Quality>(quality) : config::signals::Quality::bad;
}

}  // namespace

Beside Newest::beside(const spoolwatch::sample_t& sample) const noexcept {
  const auto of_it = [&](const auto& other) {
    return other && other->run_id == sample.run_id && other->tick == sample.tick ? &*other
                                                                                 : nullptr;
  };
  return {of_it(rods), of_it(pressures)};
}

void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor) {
  Newest newest;
  walk_log(file, prefix, visitor, newest);
}

void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor,
              Newest& newest) {
  config::record::EventReader reader(file);
  while (const lcm::LogEvent* event = reader.next()) {
    if (event->channel == prefix + kSample) {
      const auto sample = decoded<spoolwatch::sample_t>(*event, file);
      visitor.on_sample(sample, newest.beside(sample));
    } else if (event->channel == prefix + "_RODS") {
      newest.rods = decoded<spoolwatch::rods_t>(*event, file);
    } else if (event->channel == prefix + "_PRESSURES") {
      newest.pressures = decoded<spoolwatch::pressures_t>(*event, file);
    } else if (event->channel == prefix + "_ESTIMATE") {
      visitor.on_estimate(decoded<spoolwatch::estimate_t>(*event, file));
    } else if (event->channel == prefix + "_ALARM") {
      visitor.on_alarm(decoded<spoolwatch::alarm_t>(*event, file));
    }
  }
}

std::string find_prefix(const std::string& file) {
  config::record::EventReader reader(file);
  while (const lcm::LogEvent* event = reader.next()) {
    if (event->channel.ends_with(kSample)) {
      return event->channel.substr(0, event->channel.size() - std::string(kSample).size());
    }
  }
  return "";
}

config::signals::Sample to_sample(const spoolwatch::sample_t& message,
                                  const Beside& beside) noexcept {
  config::signals::Sample sample;
  sample.tick = message.tick;
  sample.t_read_ns = message.t_read_ns;
  sample.t_write_ns = message.t_write_ns;
  sample.utc_us = message.utc_us;
  sample.reference_m = message.reference_m;
  sample.y_m = message.y_m;
  sample.u_requested_V = message.u_requested_V;
  sample.u_applied_V = message.u_applied_V;
  sample.quality = quality_of(message.quality);
  sample.state = static_cast<std::uint8_t>(message.state);
  sample.saturated = message.saturated != 0;
  sample.gap = message.gap;
  if (const auto* pressures = beside.pressures; pressures != nullptr) {
    sample.pressures = {pressures->supply_Pa, pressures->in_Pa, pressures->out_Pa};
  }
  const spoolwatch::rods_t* rods = beside.rods;
  if (rods == nullptr) return sample;
  const auto count =
      std::min(static_cast<std::size_t>(std::max(rods->count, 0)), config::signals::kMaxRods);
  sample.rod_count = static_cast<std::uint8_t>(count);
  sample.rod_in_charge = static_cast<std::uint8_t>(rods->in_charge);
  sample.rod_changed = rods->changed != 0;
  sample.rod_since = rods->since_tick;
  for (std::size_t i = 0; i < count; ++i) {
    sample.rod_m[i] = rods->y_m[i];
    sample.rod_quality[i] = quality_of(rods->quality[i]);
    sample.rod_fault[i] = static_cast<std::uint8_t>(rods->fault[i]);
  }
  return sample;
}

}  // namespace workbench::replay
