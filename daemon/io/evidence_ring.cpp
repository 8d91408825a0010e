#include "daemon/io/evidence_ring.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "daemon/io/event_log.h"
#include "spoolwatch/sample_t.hpp"

namespace monitor::io {
namespace {

/// Limit of pending folders; further alarms get none.
constexpr std::size_t kMostPending = 16;

struct Parts {
  std::string_view channel;
  std::span<const std::uint8_t> data;
  std::int64_t utc_us;
};

std::uint64_t big_endian(const std::uint8_t* at, int bytes) noexcept {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8U | at[i];
  return value;
}

/// Fields of an event header as written by put_event_header().
Parts parts_of(std::span<const std::uint8_t> event) noexcept {
  const auto size = static_cast<std::size_t>(big_endian(event.data() + 20, 4));
  const auto body = event.subspan(kEventHeader);
  return {{reinterpret_cast<const char*>(body.data()), size},
          body.subspan(size),
          static_cast<std::int64_t>(big_endian(event.data() + 12, 8))};
}

}  // namespace

EvidenceRing::EvidenceRing(const EvidenceConfig& config, EvidenceFacts facts)
    : config_(config),
      facts_(std::move(facts)),
      sample_channel_(facts_.prefix + "_SAMPLE"),
      before_(std::llround(config.before_s / facts_.sample_time_s)),
      after_(std::llround(config.after_s / facts_.sample_time_s)),
      ring_(static_cast<std::size_t>(config.memory_bytes)) {}

void EvidenceRing::take(std::span<const std::uint8_t> record) {
  const Parts parts = parts_of(record);
  if (parts.channel == kGapChannel) {
    checkpoints_.clear();
    return;
  }
  if (parts.channel == kFilesChannel) {
    std::array<std::uint8_t, sizeof(void*)> address{};
    std::copy_n(parts.data.begin(), address.size(), address.begin());
    const std::unique_ptr<std::vector<EvidenceFile>> files(
        std::bit_cast<std::vector<EvidenceFile>*>(address));
    write_due(true);
    checkpoints_.clear();
    facts_.files = std::move(*files);
    return;
  }
  if (parts.channel == kAlarmChannel) {
    if (pending_.size() >= kMostPending) {
      ++skipped_;
      return;
    }
    Pending pending{};
    std::memcpy(&pending.trigger, parts.data.data(),
                std::min(parts.data.size(), sizeof pending.trigger));
    pending.until_tick = std::max(pending.trigger.tick, tick_) + after_;
    pending_.push_back(pending);
    return;
  }
  if (parts.channel == kStateChannel) checkpoints_.push_back({parts.utc_us, ring_.end()});
  ring_.push(record);
  forget_overwritten();
  if (parts.channel != sample_channel_) return;
  spoolwatch::sample_t sample;
  if (sample.decode(parts.data.data(), 0, static_cast<int>(parts.data.size())) < 0) return;
  tick_ = sample.tick;
  write_due(false);
}

void EvidenceRing::finish() { write_due(true); }

void EvidenceRing::forget_overwritten() {
  while (!checkpoints_.empty() && checkpoints_.front().at < ring_.begin()) checkpoints_.pop_front();
}

void EvidenceRing::write_due(bool all) {
  while (!pending_.empty() && (all || tick_ > pending_.front().until_tick)) {
    write(pending_.front());
    pending_.pop_front();
  }
}

void EvidenceRing::write(const Pending& pending) {
  // The newest snapshot that is early enough, otherwise the oldest one before the alarm.
  const std::int64_t wanted = pending.trigger.tick - before_;
  auto start = checkpoints_.end();
  for (auto i = checkpoints_.begin(); i != checkpoints_.end(); ++i) {
    const bool usable = i->tick <= pending.trigger.tick;
    if (usable && (start == checkpoints_.end() || i->tick <= wanted)) start = i;
  }
  PackContents contents;
  contents.trigger = pending.trigger;
  contents.last_tick = tick_;
  std::uint64_t from = ring_.begin();
  std::vector<std::uint8_t> state;
  if (start != checkpoints_.end()) {
    contents.first_tick = start->tick;
    from = ring_.read(start->at, record_);
    const Parts parts = parts_of(record_);
    state.assign(parts.data.begin(), parts.data.end());
    contents.state = state;
  } else {
    contents.first_tick = -1;
    contents.inexact =
        "the snapshot before the alarm is lost: memory_bytes is too small or messages were "
        "dropped";
  }
  contents.events = [&](const std::function<void(std::span<std::uint8_t>)>& each) {
    for (std::uint64_t at = from; at != ring_.end();) {
      at = ring_.read(at, record_);
      if (parts_of(record_).channel != kStateChannel) each(record_);
    }
  };
  const int error = write_pack(config_.folder, facts_, contents, own_);
  error_ = error;
  ++(error == 0 ? written_ : failed_);
  prune_packs(config_.folder, config_.packs, config_.total_bytes, own_);
}

EvidenceStatus EvidenceRing::status() const noexcept {
  EvidenceStatus status;
  status.written = written_.load(std::memory_order_relaxed);
  status.failed = failed_.load(std::memory_order_relaxed);
  status.skipped = skipped_.load(std::memory_order_relaxed);
  status.error = error_.load(std::memory_order_relaxed);
  return status;
}

}  // namespace monitor::io
