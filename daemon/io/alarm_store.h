// The lives of alarms across a restart, in FOLDER/alarms.json: written whole beside it,
// synchronised and renamed, off the threads that must not wait. Shelves keep their time of day:
// what passes while the daemon is away counts.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/io/background_writer.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::io {

/// TOML [alarms].
struct AlarmConfig {
  std::string folder;                  ///< of alarms.json and audit.log; empty: neither is kept
  std::int64_t audit_bytes = 1 << 20;  ///< of audit.log, twice as much with the one before
  estimator::fdi::AlarmRules rules;    ///< of guards and of the daemon's own alarms

  void visit(config::schema::Visitor& v);
};

[[nodiscard]] std::string print_lives(const std::vector<estimator::fdi::PersistedAlarm>& lives,
                                      const std::string& rig_id, std::int64_t utc_us);

struct LoadedLives {
  std::vector<estimator::fdi::PersistedAlarm> lives{};
  std::string wrong{};  ///< why there are none, in one line; empty: nothing is wrong
};
/// Never throws: what is damaged or of another rig gives no lives.
[[nodiscard]] LoadedLives parse_lives(const std::string& text, const std::string& rig_id,
                                      std::int64_t utc_us);

class AlarmStore {
 public:
  /// `writer` writes, also what is queued when this ends.
  AlarmStore(const std::filesystem::path& folder, std::string rig_id, BackgroundWriter& writer);

  /// Before the first save(). A file that does not exist is nothing wrong.
  [[nodiscard]] LoadedLives load(std::int64_t utc_us) const;
  /// Saves when the book's lives have changed since the last time; does not wait for the disk. One
  /// thread.
  void keep(const estimator::fdi::AlarmBook& book, std::int64_t utc_us);

  /// errno of the last save, 0 when it went well. Any thread.
  [[nodiscard]] int error() const noexcept { return *error_; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  std::filesystem::path file_;
  std::string rig_id_;
  BackgroundWriter& writer_;
  std::uint64_t saved_ = 0;  ///< AlarmBook::changes() of what was saved last
  std::shared_ptr<std::atomic<int>> error_ = std::make_shared<std::atomic<int>>(0);  ///< its jobs'
};

/// Writes the file under a temporary name beside it, synchronises and renames it; 0 or errno.
[[nodiscard]] int write_durably(const std::filesystem::path& file,
                                const std::string& text) noexcept;

}  // namespace monitor::io
