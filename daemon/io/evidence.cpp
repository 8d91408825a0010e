#include "daemon/io/evidence.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>

#include "config/schema/error.h"
#include "daemon/io/byte_buffers.h"
#include "daemon/io/event_log.h"
#include "daemon/io/evidence_pack.h"
#include "daemon/io/evidence_ring.h"

namespace monitor::io {
namespace {

constexpr std::size_t kQueueBytes = 4 << 20;
/// Snapshot interval as a share of before_s, so that a folder is not much longer.
constexpr double kStateShare = 0.5;
constexpr double kLeastState_s = 1.0;

template <std::size_t n>
void copy_text(const std::string& text, char (&to)[n]) {
  text.copy(to, n - 1);
}

}  // namespace

void EvidenceConfig::visit(config::schema::Visitor& v) {
  v.path({"folder", "parent of the evidence folders; empty: no evidence"}, folder);
  v.number({"before_s", "time before an alarm that is kept"}, before_s, {0.1, 600.0});
  v.number({"after_s", "time after an alarm that is kept"}, after_s, {0.0, 600.0});
  v.integer({"packs", "number of folders kept, oldest removed first"}, packs, {1, 100000});
  v.integer({"total_bytes", "total size of all folders"}, total_bytes, {1 << 20, 1LL << 42});
  v.integer({"memory_bytes", "memory for the newest messages; bounds one folder"}, memory_bytes,
            {1 << 20, 1LL << 30});
}

Evidence::Evidence(const EvidenceConfig& config, EvidenceFacts facts, bool background)
    : background_(background),
      state_every_(std::max<std::int64_t>(
          1, std::llround(std::max(kStateShare * config.before_s, kLeastState_s) /
                          facts.sample_time_s))),
      queue_(std::make_unique<ByteQueue>(kQueueBytes)) {
  std::error_code error;
  std::filesystem::create_directories(config.folder, error);
  if (error) {
    throw config::schema::bad_config(config.folder,
                                     "cannot keep evidence here: " + error.message());
  }
  OwnPacks none;
  prune_packs(config.folder, config.packs, config.total_bytes, none);
  ring_ = std::make_unique<EvidenceRing>(config, std::move(facts));
  if (background_) thread_.start([this] { drain(); });
}

Evidence::~Evidence() { finish(); }

bool Evidence::push(std::string_view channel, std::span<const std::uint8_t> data,
                    std::int64_t utc_us) noexcept {
  std::array<std::uint8_t, kEventHeader + kMaxChannel> head{};
  channel = channel.substr(0, kMaxChannel);
  put_event_header(std::span(head).first<kEventHeader>(), utc_us, channel.size(), data.size());
  std::copy(channel.begin(), channel.end(), head.begin() + kEventHeader);
  return queue_->push(std::span(head).first(kEventHeader + channel.size()), data);
}

void Evidence::record(std::string_view channel, std::span<const std::uint8_t> data,
                      std::int64_t utc_us) noexcept {
  if (lost_ && push(kGapChannel, {}, utc_us)) lost_ = false;
  if (new_files_ != nullptr) {
    const auto address = std::bit_cast<std::array<std::uint8_t, sizeof(void*)>>(new_files_.get());
    if (push(kFilesChannel, address, utc_us)) {
      static_cast<void>(new_files_.release());  // owned by the ring now
    }
  }
  if (lost_ || !push(channel, data, utc_us)) {
    lost_ = true;
    next_state_ = 0;  // replay needs a new snapshot from here on
    dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  if (!background_) drain();
}

void Evidence::state(std::span<const std::uint8_t> snapshot, std::int64_t tick) noexcept {
  next_state_ = tick + state_every_;
  record(kStateChannel, snapshot, tick);
}

void Evidence::reconfigure(std::vector<EvidenceFile> files) {
  new_files_ = std::make_unique<std::vector<EvidenceFile>>(std::move(files));
  next_state_ = 0;
}

void Evidence::alarm(const estimator::fdi::Alarm& alarm, std::int64_t utc_us) noexcept {
  EvidenceTrigger trigger;
  trigger.tick = alarm.tick;
  trigger.utc_us = utc_us;
  trigger.value = alarm.value;
  trigger.severity = static_cast<std::int8_t>(alarm.severity);
  trigger.direction = alarm.direction;
  trigger.first_up = alarm.first_up;
  copy_text(alarm.source, trigger.source);
  copy_text(alarm.name, trigger.name);
  record(kAlarmChannel, {reinterpret_cast<const std::uint8_t*>(&trigger), sizeof trigger}, utc_us);
}

void Evidence::finish() {
  thread_.stop();
  drain();
  ring_->finish();
}

EvidenceStatus Evidence::status() const noexcept {
  EvidenceStatus status = ring_->status();
  status.dropped = dropped_.load(std::memory_order_relaxed);
  return status;
}

void Evidence::drain() {
  while (queue_->pop(record_)) ring_->take(record_);
}

}  // namespace monitor::io
