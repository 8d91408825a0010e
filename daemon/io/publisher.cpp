#include "daemon/io/publisher.h"

#include <span>
#include <utility>

#include "config/messages/connect.h"
#include "daemon/io/evidence.h"
#include "daemon/io/messages.h"
#include "daemon/io/recorder.h"
#include "spoolwatch/health_t.hpp"

namespace monitor::io {
namespace {

// Exceeds the largest message of an ordinary configuration; grows if necessary.
constexpr std::size_t kBufferBytes = 16 << 10;
constexpr std::size_t kMaxChannel = 63;  // LCM's own limit

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
