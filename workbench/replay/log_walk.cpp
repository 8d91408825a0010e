#include "workbench/replay/log_walk.h"

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

}  // namespace

void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor) {
  config::record::EventReader reader(file);
  while (const lcm::LogEvent* event = reader.next()) {
    if (event->channel == prefix + kSample) {
      visitor.on_sample(decoded<spoolwatch::sample_t>(*event, file));
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

estimator::fdi::Sample to_sample(const spoolwatch::sample_t& message) noexcept {
  estimator::fdi::Sample sample;
  sample.tick = message.tick;
  sample.t_read_ns = message.t_read_ns;
  sample.t_write_ns = message.t_write_ns;
  sample.utc_us = message.utc_us;
  sample.reference_m = message.reference_m;
  sample.y_m = message.y_m;
  sample.u_requested_V = message.u_requested_V;
  sample.u_applied_V = message.u_applied_V;
  const bool known = message.quality >= 0 && message.quality <= 3;
  sample.quality =
      known ? static_cast<estimator::fdi::Quality>(message.quality) : estimator::fdi::Quality::bad;
  sample.state = static_cast<std::uint8_t>(message.state);
  sample.saturated = message.saturated != 0;
  sample.gap = message.gap;
  return sample;
}

}  // namespace workbench::replay
