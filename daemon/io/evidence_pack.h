// One evidence folder on disk, created atomically.
//
//   pack.json           identity, alarm, replay command
//   README.txt          the same as text
//   log.lcmlog          messages from the snapshot on, an LCM event log
//   state.bin           state of the fault detection before the first sample of the log
//   pipeline.toml       its complete configuration
//   configuration.toml  the daemon's, and the files that it names (model, bands, ...)
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "daemon/io/evidence.h"

namespace monitor::io {

/// The alarm that triggered the folder.
struct EvidenceTrigger {
  std::int64_t tick = 0;
  std::int64_t utc_us = 0;
  double value = 0.0;
  std::int8_t severity = 0;
  std::int8_t direction = 0;
  bool first_up = false;
  char source[96] = {};
  char name[96] = {};
};

struct PackContents {
  EvidenceTrigger trigger;
  std::int64_t first_tick = 0;  ///< first sample of the log
  std::int64_t last_tick = 0;
  std::string inexact;  ///< why the folder cannot be replayed; empty: it can
  std::span<const std::uint8_t> state;
  /// Passes each event of the log, in order, to a callback.
  std::function<void(const std::function<void(std::span<std::uint8_t>)>&)> events;
};

/// Folders that this process has written and that are there, the newest last: the order in which
/// they are removed, whatever the wall clock was set to meanwhile.
using OwnPacks = std::vector<std::filesystem::path>;

/// 0 or errno. Appends to `own`.
[[nodiscard]] int write_pack(const std::filesystem::path& folder, const EvidenceFacts& facts,
                             const PackContents& contents, OwnPacks& own);

/// Removes the oldest folders beyond the limits, those of other runs first, and the incomplete
/// folders that an interrupted daemon leaves.
void prune_packs(const std::filesystem::path& folder, std::int64_t packs, std::int64_t bytes,
                 OwnPacks& own);

}  // namespace monitor::io
