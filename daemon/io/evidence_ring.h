// A bounded ring of the newest messages, from which the evidence folders are written. One thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "daemon/io/byte_buffers.h"
#include "daemon/io/evidence.h"
#include "daemon/io/evidence_pack.h"

namespace monitor::io {

/// Channels of internal records.
inline constexpr std::string_view kStateChannel = "#state";
inline constexpr std::string_view kAlarmChannel = "#alarm";
inline constexpr std::string_view kGapChannel = "#gap";
/// Carries the address of a std::vector<EvidenceFile> whose ownership passes to the ring.
inline constexpr std::string_view kFilesChannel = "#files";

class EvidenceRing {
 public:
  EvidenceRing(const EvidenceConfig& config, EvidenceFacts facts);

  /// Adds a record: a log event or one of the above.
  void take(std::span<const std::uint8_t> record);
  /// Writes all pending folders with the messages so far.
  void finish();

  [[nodiscard]] EvidenceStatus status() const noexcept;

 private:
  struct Checkpoint {
    std::int64_t tick;
    std::uint64_t at;  ///< position in the ring
  };
  struct Pending {
    EvidenceTrigger trigger;
    std::int64_t until_tick;
  };
  void forget_overwritten();
  void write_due(bool all);
  void write(const Pending& pending);

  EvidenceConfig config_;
  EvidenceFacts facts_;
  OwnPacks own_;
  std::string sample_channel_;
  std::int64_t before_, after_;  ///< ticks
  ByteBacklog ring_;
  std::deque<Checkpoint> checkpoints_;
  std::deque<Pending> pending_;
  std::int64_t tick_ = 0;  ///< newest sample
  std::vector<std::uint8_t> record_;
  std::atomic<std::int64_t> written_{0}, failed_{0}, skipped_{0};
  std::atomic<int> error_{0};
};

}  // namespace monitor::io
