// Evidence of each alarm: a folder with what was measured, estimated and told from before_s before
// to after_s after it, the state of the fault detection at its beginning, the configuration and the
// model; `spoolwatch replay FOLDER` leads to the same alarm, bit for bit.
//
// record(), state() and alarm() copy into a bounded lock-free queue and return; a thread of its own
// keeps the newest messages in a bounded ring and writes the folders. In virtual time (`background`
// false) that is done at once. What does not fit or cannot be written is counted. A snapshot of the
// state goes through the queue every few seconds, so that each folder begins with one: a pipeline
// restored from it goes on exactly, whatever its estimators' memory (estimator/state_archive.h).
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
  std::string folder;  ///< where the folders go; empty: no evidence is kept
  double before_s = 10.0;
  double after_s = 5.0;
  std::int64_t packs = 50;                 ///< folders kept, oldest removed first
  std::int64_t total_bytes = 512LL << 20;  ///< of all of them
  std::int64_t memory_bytes = 16 << 20;    ///< of the ring, and so of one folder

  void visit(config::schema::Visitor& v);
};

/// A file that each folder gets.
struct EvidenceFile {
  std::string name;
  std::string text;
};

/// What does not change while the daemon runs.
struct EvidenceFacts {
  std::string rig_id, config_hash, prefix;  ///< prefix of the channels
  std::int64_t run_id = 0;
  double sample_time_s = 0.0;
  std::vector<EvidenceFile> files{};
};

struct EvidenceStatus {
  std::int64_t written = 0;  ///< folders
  std::int64_t failed = 0;   ///< folders that could not be written
  std::int64_t skipped = 0;  ///< alarms without a folder: too many at a time
  std::int64_t dropped = 0;  ///< messages that did not fit into the queue
  int error = 0;             ///< errno of the newest failure
};

class Evidence {
 public:
  /// Throws config::schema::Error when the folder cannot be made.
  Evidence(const EvidenceConfig& config, EvidenceFacts facts, bool background);
  ~Evidence();
  Evidence(const Evidence&) = delete;
  Evidence& operator=(const Evidence&) = delete;

  /// One message, as published. This and the next three: one thread.
  void record(std::string_view channel, std::span<const std::uint8_t> data,
              std::int64_t utc_us) noexcept;
  /// Whether a snapshot is due before the sample of this tick is published.
  [[nodiscard]] bool wants_state(std::int64_t tick) const noexcept { return tick >= next_state_; }
  void state(std::span<const std::uint8_t> snapshot, std::int64_t tick) noexcept;
  /// From the next snapshot on another configuration applies: what is asked for is written with
  /// what there is, and later folders get these files.
  void reconfigure(std::vector<EvidenceFile> files);
  /// Asks for a folder: call it after the alarm was published.
  void alarm(const estimator::fdi::Alarm& alarm, std::int64_t utc_us) noexcept;

  /// Writes what is asked for with what there is, and stops: call it last.
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
  /// Of another configuration, on their way to the ring.
  std::unique_ptr<std::vector<EvidenceFile>> new_files_;
  bool lost_ = false;  ///< messages, since the last that fitted
  std::unique_ptr<ByteQueue> queue_;
  std::unique_ptr<EvidenceRing> ring_;  ///< of the writing thread
  std::vector<std::uint8_t> record_;    ///< of the writing thread
  std::atomic<std::int64_t> dropped_{0};
  DrainThread thread_;  ///< the last: it uses the others
};

}  // namespace monitor::io
