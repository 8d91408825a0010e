#include "workbench/replay/log_walk.h"

#include <algorithm>

#include "config/record/log_reader.h"
#include "spoolwatch/sample_t.hpp"

namespace workbench::replay {
namespace {

using config::messages::MessageKind;
using config::record::LogEvent;
using config::record::LogReader;

config::signals::Quality quality_of(std::int8_t quality) noexcept {
  const bool known = quality >= 0 && quality <= 3;
  return known ? static_cast<config::signals::Quality>(quality) : config::signals::Quality::bad;
}

void add_rods(const spoolwatch::rods_t& rods, config::signals::Sample& sample) noexcept {
  const auto count =
      std::min(static_cast<std::size_t>(std::max(rods.count, 0)), config::signals::kMaxRods);
  sample.rod_count = static_cast<std::uint8_t>(count);
  sample.rod_in_charge = static_cast<std::uint8_t>(rods.in_charge);
  sample.rod_changed = rods.changed != 0;
  sample.rod_since = rods.since_tick;
  for (std::size_t i = 0; i < count; ++i) {
    sample.rod_m[i] = rods.y_m[i];
    sample.rod_quality[i] = quality_of(rods.quality[i]);
    sample.rod_fault[i] = static_cast<std::uint8_t>(rods.fault[i]);
  }
}

}  // namespace

void SampleHandler::on(const spoolwatch::sample_t& message) {
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
  const auto belongs = [&](const auto& other) {
    return other && other->run_id == message.run_id && other->tick == message.tick;
  };
  if (belongs(pressures_)) {
    sample.pressures = {pressures_->supply_Pa, pressures_->in_Pa, pressures_->out_Pa};
  }
  if (belongs(rods_)) add_rods(*rods_, sample);
  take(sample, message);
}

void walk_log(const std::string& file, const std::string& prefix,
              config::messages::MessageHandler& handler) {
  LogReader log(file);
  while (const LogEvent* event = log.next()) {
    const auto kind = config::messages::kind_of(event->channel, prefix);
    if (kind && kind != MessageKind::health) log.deliver(*kind, handler);
  }
}

std::string find_prefix(const std::string& file) {
  const std::string_view ending = config::messages::channel_ending(MessageKind::sample);
  LogReader log(file);
  while (const LogEvent* event = log.next()) {
    if (event->channel.ends_with(ending)) {
      return event->channel.substr(0, event->channel.size() - ending.size());
    }
  }
  return "";
}

}  // namespace workbench::replay
