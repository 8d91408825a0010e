// Evidence of each alarm: a folder with all messages from before_s before to after_s after the
// alarm, the state of the fault detection at its beginning, the configuration and the model;
// `spoolwatch replay FOLDER` reproduces the alarm bit for bit.
//
// record(), state() and alarm() copy into a bounded lock-free queue and return; a background
// thread keeps the newest messages in a bounded ring and writes the folders. In virtual time
// (`background` false) the calling thread does so. Messages that do not fit and folders that cannot
// be written are counted. A snapshot of the state is queued every few seconds, so that each folder
// begins with one, from which a pipeline continues exactly (estimator/state_archive.h).
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
#include "estimator/fdi/alarm.h"

namespace monitor::io {

class ByteQueue;
class EvidenceRing;

/// TOML [evidence].
struct EvidenceConfig {
  std::string folder;  ///< parent of the evidence folders; empty: no evidence
  double before_s = 10.0;
  double after_s = 5.0;
  std::int64_t packs = 50;                 ///< folders kept, oldest removed first
  std::int64_t total_bytes = 512LL << 20;  ///< limit for all folders together
  std::int64_t memory_bytes = 16 << 20;    ///< size of the ring, which bounds one folder

  void visit(config::schema::Visitor& v);
};

/// A file copied into each folder.
struct EvidenceFile {
  std::string name;
  std::string text;
};

/// Facts that stay constant while the daemon runs.
struct EvidenceFacts {
  std::string rig_id, config_hash, prefix;  ///< prefix: of the channels
  std::int64_t run_id = 0;
  double sample_time_s = 0.0;
  std::vector<EvidenceFile> files{};
};

struct EvidenceStatus {
  std::int64_t written = 0;  ///< folders
  std::int64_t failed = 0;   ///< folders that could not be written
  std::int64_t skipped = 0;  ///< alarms without a folder: too many at once
  std::int64_t dropped = 0;  ///< messages lost to a full queue
  int error = 0;             ///< errno of the newest failure
};

class Evidence {
 public:
  /// Throws config::schema::Error when the folder cannot be created.
  Evidence(const EvidenceConfig& config, EvidenceFacts facts, bool background);
  ~Evidence();
  Evidence(const Evidence&) = delete;
  Evidence& operator=(const Evidence&) = delete;

  /// Adds a published message. Call this and the next three functions from one thread.
  void record(std::string_view channel, std::span<const std::uint8_t> data,
              std::int64_t utc_us) noexcept;
  /// True when a snapshot is due before the sample of this tick is published.
  [[nodiscard]] bool wants_state(std::int64_t tick) const noexcept { return tick >= next_state_; }
  void state(std::span<const std::uint8_t> snapshot, std::int64_t tick) noexcept;
  /// Switches to another configuration at the next snapshot: pending folders are written with the
  /// messages so far, later folders get these files.
  void reconfigure(std::vector<EvidenceFile> files);
  /// Requests a folder; call after publishing the alarm.
  void alarm(const estimator::fdi::Alarm& alarm, std::int64_t utc_us) noexcept;

  /// Writes pending folders with the messages so far and stops. Call last.
  void finish();
  /// Any thread.
  [[nodiscard]] EvidenceStatus status() const noexcept;

 private:
  bool push(std::string_view channel, std::span<const std::uint8_t> data,
            std::int64_t utc_us) noexcept;
  void drain();

  const bool background_;
  std::int64_t state_every_;  ///< ticks
  std::int64_t next_state_ = 0;
  /// Files of the new configuration, in transit to the ring.
  std::unique_ptr<std::vector<EvidenceFile>> new_files_;
  bool lost_ = false;  ///< messages have been lost since the last one queued
  std::unique_ptr<ByteQueue> queue_;
  std::unique_ptr<EvidenceRing> ring_;  ///< writing thread only
  std::vector<std::uint8_t> record_;    ///< writing thread only
  std::atomic<std::int64_t> dropped_{0};
  DrainThread thread_;  ///< last member: uses the others
};

}  // namespace monitor::io
