// Records every published message in rotating LCM event logs, readable by any LCM tool.
//
// record() copies the encoded bytes into a bounded lock-free queue and returns; a background
// thread writes them. A full queue drops the newest message and counts it. In virtual time
// (`background` false) record() writes at once, so the same input gives the same bytes.
// When the disk is full or fails, the newest messages stay in a bounded memory backlog (the oldest
// are overwritten and counted as lost) and are written when space returns; a file never ends with
// part of an event. Files: FOLDER/spoolwatch-RUNID-NNNNN.lcmlog, at most `files` of them in FOLDER.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/io/drain_thread.h"

namespace monitor::io {

class EventLog;
class ByteBacklog;
class ByteQueue;

struct RecorderConfig {
  std::string folder;                    // "" records nothing: no Recorder is made
  std::int64_t file_bytes = 64 << 20;    // cap of one file
  std::int64_t files = 16;               // logs kept in the folder, oldest removed first
  std::int64_t queue_bytes = 2 << 20;    // about 30 s of a stalled disk
  std::int64_t backlog_bytes = 4 << 20;  // newest kept in memory while the disk is full

  /// Fields of the table [recorder].
  void visit(config::schema::Visitor& v);
};

/// Figures since the start of the recorder.
struct RecorderStatus {
  std::int64_t written_records = 0;
  std::int64_t dropped_records = 0;  // queue full
  std::int64_t lost_records = 0;     // overwritten in memory while the disk was full
  std::int64_t removed_records = 0;  // in logs that were removed while they were written
  bool disk_full = false;            // no space, quota or file-size limit
  bool write_failed = false;         // any other reason
  int error = 0;                     // errno of the present failure
};

class Recorder {
 public:
  /// Opens the first file. Throws config::schema::Error when the folder cannot be created or
  /// written; a full disk is only a condition. `config.folder` must not be empty.
  Recorder(const RecorderConfig& config, std::int64_t run_id, bool background);
  /// Calls finish().
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Records a message with the log time `utc_us`. One thread. Neither blocks nor allocates in
  /// background mode.
  void record(std::string_view channel, std::span<const std::uint8_t> data,
              std::int64_t utc_us) noexcept;

  /// Writes the queued messages as far as the disk allows and stops. Call last. Returns the number
  /// of messages that are not on disk.
  std::int64_t finish();

  /// Any thread.
  [[nodiscard]] RecorderStatus status() const noexcept;

 private:
  void drain();
  void flush_backlog();

  std::unique_ptr<EventLog> log_;
  std::unique_ptr<ByteQueue> queue_;      // one producer (record), one consumer (run)
  std::unique_ptr<ByteBacklog> backlog_;  // writing thread only
  std::vector<std::uint8_t> record_;      // writing thread only
  const bool background_;
  int retry_in_ = 0;  // drains until the next attempt after a failure
  std::atomic<std::int64_t> written_{0};
  std::atomic<std::int64_t> dropped_{0};
  std::atomic<std::int64_t> lost_{0};
  std::atomic<std::int64_t> removed_{0};
  std::atomic<int> error_{0};
  DrainThread thread_;  // last member: uses the others
};

}  // namespace monitor::io
