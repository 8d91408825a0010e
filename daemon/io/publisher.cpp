#include "daemon/io/publisher.h"

#include <algorithm>
#include <span>
#include <utility>

#include "config/messages/connect.h"
#include "config/signals/sample.h"
#include "daemon/io/event_log.h"
#include "daemon/io/evidence.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace monitor::io {

// Converts samples, estimates and alarms to the LCM types; the publisher sets run_id, seq and
// stamp. Strings and arrays of the target are reused to avoid allocation.

void fill(spoolwatch::sample_t& message, const config::signals::Sample& sample,
          double sample_time_s);
/// Fills everything except the ids, which may be fewer than the rods.
void fill(spoolwatch::rods_t& message, const config::signals::Sample& sample);
void fill(spoolwatch::pressures_t& message, const config::signals::Sample& sample);
void fill(spoolwatch::estimate_t& message, const estimator::fdi::EstimateEvent& event);
void fill(spoolwatch::alarm_t& message, const estimator::fdi::Alarm& alarm, bool repeat);

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

namespace {

// Exceeds the largest message of an ordinary configuration; grows if necessary.
constexpr std::size_t kBufferBytes = 16 << 10;

}  // namespace

struct Publisher::Messages {
  spoolwatch::sample_t sample{};
  spoolwatch::rods_t rods{};
  spoolwatch::pressures_t pressures{};
  spoolwatch::estimate_t estimate{};
  spoolwatch::alarm_t alarm{};
};

void PublisherConfig::visit(config::schema::Visitor& v) {
  v.text({"url", "LCM provider URL; empty: nothing is sent"}, url);
  v.text({"prefix", "prefix of the channel names"}, prefix);
}

Publisher::Publisher(const PublisherConfig& config, std::int64_t run_id, double sample_time_s,
                     Recorder* recorder)
    : lcm_(config.url.empty() ? nullptr
                              : config::messages::connect(config.url, /*receives=*/false)),
      messages_(std::make_unique<Messages>()),
      recorder_(recorder),
      run_id_(run_id),
      sample_time_s_(sample_time_s),
      sample_{config.prefix + "_SAMPLE"},
      rods_{config.prefix + "_RODS"},
      pressures_{config.prefix + "_PRESSURES"},
      estimate_{config.prefix + "_ESTIMATE"},
      alarm_{config.prefix + "_ALARM"},
      health_{config.prefix + "_HEALTH"},
      buffer_(kBufferBytes) {
  if (pressures_.name.size() > kMaxChannel) {
    throw config::schema::bad_config("[lcm] prefix", "channel " + pressures_.name + " is too long",
                                     "53 characters");
  }
}

Publisher::~Publisher() = default;

void Publisher::name_rods(std::vector<std::string> rods) { messages_->rods.rod = std::move(rods); }

void Publisher::sample(const config::signals::Sample& sample) {
  if (sample.rod_count > 0) {
    fill(messages_->rods, sample);
    send(rods_, messages_->rods, {sample.utc_us, sample.t_read_ns});
  }
  if (tells_pressures_) {
    fill(messages_->pressures, sample);
    send(pressures_, messages_->pressures, {sample.utc_us, sample.t_read_ns});
  }
  fill(messages_->sample, sample, sample_time_s_);
  send(sample_, messages_->sample, {sample.utc_us, sample.t_read_ns});
}

void Publisher::estimate(const estimator::fdi::EstimateEvent& event, Stamp stamp) {
  fill(messages_->estimate, event);
  send(estimate_, messages_->estimate, stamp);
}

void Publisher::alarm(const estimator::fdi::Alarm& alarm, bool repeat, Stamp stamp) {
  fill(messages_->alarm, alarm, repeat);
  send(alarm_, messages_->alarm, stamp);
}

void Publisher::health(spoolwatch::health_t& message, Stamp stamp) {
  send(health_, message, stamp);
}

PublisherStatus Publisher::status() const noexcept {
  return {sent_.load(std::memory_order_relaxed), failures_.load(std::memory_order_relaxed)};
}

template <class Message>
void Publisher::send(Channel& channel, Message& message, Stamp stamp) {
  message.run_id = run_id_;
  message.seq = channel.seq++;
  message.utc_us = stamp.utc_us;
  message.mono_ns = stamp.mono_ns;
  const int size = message.getEncodedSize();
  if (static_cast<std::size_t>(size) > buffer_.size())
    buffer_.resize(static_cast<std::size_t>(size));
  message.encode(buffer_.data(), 0, size);
  if (lcm_) {
    const bool failed =
        lcm_->publish(channel.name, buffer_.data(), static_cast<unsigned>(size)) != 0;
    (failed ? failures_ : sent_).fetch_add(1, std::memory_order_relaxed);
  }
  const auto bytes = std::span(buffer_).first(static_cast<std::size_t>(size));
  if (recorder_ != nullptr) recorder_->record(channel.name, bytes, stamp.utc_us);
  if (evidence_ != nullptr) evidence_->record(channel.name, bytes, stamp.utc_us);
}

}  // namespace monitor::io
