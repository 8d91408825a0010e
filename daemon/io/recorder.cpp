#include "daemon/io/recorder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "config/schema/error.h"
#include "daemon/io/byte_buffers.h"
#include "daemon/io/event_log.h"

namespace monitor::io {
namespace {

// Drains until the next attempt after a disk failure: about 1 s, or 200 samples in virtual time.
constexpr int kRetryBackground = 20;
constexpr int kRetryInline = 200;

bool means_full(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

config::schema::ConfigError cannot_record(const std::filesystem::path& where,
                                          const std::string& why) {
  return config::schema::bad_config(where.string(), "cannot record here: " + why);
}

}  // namespace

void RecorderConfig::visit(config::schema::Visitor& v) {
  constexpr std::int64_t kMiB = 1 << 20;
  v.path({"folder", "folder of the logs; empty: nothing is recorded"}, folder);
  v.integer({"file_bytes", "size limit of one log file"}, file_bytes, {4096, 1LL << 40});
  v.integer({"files", "number of logs kept in the folder, oldest removed first"}, files,
            {1, 100000});
  v.integer({"queue_bytes", "queue between detector and recorder"}, queue_bytes,
            {4096, 1024 * kMiB});
  v.integer({"backlog_bytes", "newest data kept in memory while the disk is full"}, backlog_bytes,
            {4096, 1024 * kMiB});
}

Recorder::Recorder(const RecorderConfig& config, std::int64_t run_id, bool background)
    : log_(std::make_unique<EventLog>(config.folder, run_id, config.file_bytes, config.files)),
      queue_(std::make_unique<ByteQueue>(config.queue_bytes)),
      backlog_(std::make_unique<ByteBacklog>(config.backlog_bytes)),
      background_(background) {
  std::error_code error;
  std::filesystem::create_directories(config.folder, error);
  if (error) throw cannot_record(config.folder, error.message());
  // A disk that is full at startup is a condition, as if it filled up later.
  const int failed = log_->open();
  if (failed != 0 && !means_full(failed)) throw cannot_record(log_->file(), std::strerror(failed));
  error_ = failed;
  if (background_) thread_.start([this] { drain(); });
}

Recorder::~Recorder() { finish(); }

std::int64_t Recorder::finish() {
  thread_.stop();
  retry_in_ = 0;
  drain();
  return dropped_ + lost_ + backlog_->records() + log_->removed();
}

void Recorder::record(std::string_view channel, std::span<const std::uint8_t> data,
                      std::int64_t utc_us) noexcept {
  std::array<std::uint8_t, kEventHeader + kMaxChannel> head{};
  channel = channel.substr(0, kMaxChannel);
  put_event_header(std::span(head).first<kEventHeader>(), utc_us, channel.size(), data.size());
  std::copy(channel.begin(), channel.end(), head.begin() + kEventHeader);
  if (!queue_->push(std::span(head).first(kEventHeader + channel.size()), data)) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  if (!background_) drain();
}

RecorderStatus Recorder::status() const noexcept {
  RecorderStatus status;
  status.written_records = written_.load(std::memory_order_relaxed);
  status.dropped_records = dropped_.load(std::memory_order_relaxed);
  status.lost_records = lost_.load(std::memory_order_relaxed);
  status.removed_records = removed_.load(std::memory_order_relaxed);
  status.error = error_.load(std::memory_order_relaxed);
  status.disk_full = means_full(status.error);
  status.write_failed = status.error != 0 && !status.disk_full;
  return status;
}

void Recorder::drain() {
  while (queue_->pop(record_)) lost_.fetch_add(backlog_->push(record_), std::memory_order_relaxed);
  if (retry_in_ > 0) {
    --retry_in_;
  } else {
    flush_backlog();
  }
}

void Recorder::flush_backlog() {
  while (!backlog_->empty()) {
    for (std::uint64_t at = backlog_->begin(); at != backlog_->end();) {
      const std::uint64_t next = backlog_->read(at, record_);
      if (!log_->add(record_)) break;
      at = next;
    }
    const EventLog::Written written = log_->write();
    for (std::size_t i = 0; i < written.events; ++i) backlog_->drop_oldest();
    written_.fetch_add(static_cast<std::int64_t>(written.events), std::memory_order_relaxed);
    removed_.store(log_->removed(), std::memory_order_relaxed);
    if (written.error != 0) {
      error_ = written.error;
      retry_in_ = background_ ? kRetryBackground : kRetryInline;
      return;
    }
  }
  if (error_ != 0 && log_->open() == 0) error_ = 0;
}

}  // namespace monitor::io
