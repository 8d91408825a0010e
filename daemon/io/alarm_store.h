// Persists alarm states across a restart in FOLDER/alarms.json, written in the background and
// replaced atomically. Shelving keeps its wall-clock end, so time while the daemon is down counts.
// FOLDER/history.log keeps every change of an alarm, one JSON line each, and starts and ends of the
// daemon, for `spoolwatch alarms --statistics`.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/io/background_writer.h"
#include "daemon/io/capped_file.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::io {

/// TOML [alarms].
struct AlarmConfig {
  std::string folder;  ///< folder for alarms.json, audit.log, ...; empty: no files
  /// Limit of audit.log, refused.log and history.log each; twice as much with their predecessors.
  std::int64_t audit_bytes = 1 << 20;
  estimator::fdi::AlarmRules rules;  ///< for guards and system alarms

  void visit(config::schema::Visitor& v);
};

[[nodiscard]] std::string print_lives(const std::vector<estimator::fdi::PersistedAlarm>& lives,
                                      const std::string& rig_id, std::int64_t utc_us);

struct LoadedLives {
  std::vector<estimator::fdi::PersistedAlarm> lives{};
  std::string wrong{};  ///< why nothing could be loaded, in one line; empty: no error
};
/// Never throws: a damaged file or one of another rig yields no states.
[[nodiscard]] LoadedLives parse_lives(const std::string& text, const std::string& rig_id,
                                      std::int64_t utc_us);

class AlarmStore {
 public:
  /// `writer` must outlive this object; it also writes what is still queued then.
  AlarmStore(const std::filesystem::path& folder, std::string rig_id, BackgroundWriter& writer,
             std::int64_t history_bytes = 1 << 20);
  ~AlarmStore();
  AlarmStore(const AlarmStore&) = delete;
  AlarmStore& operator=(const AlarmStore&) = delete;

  /// Call before the first keep(). A missing file is no error.
  [[nodiscard]] LoadedLives load(std::int64_t utc_us) const;
  /// Saves when alarm states have changed since the last call; does not block on the disk. One
  /// thread.
  void keep(const estimator::fdi::AlarmBook& book, std::int64_t utc_us);

  /// Appends the alarm to the history where its severity or state has changed. One thread.
  void note(const estimator::fdi::Alarm& alarm, std::int64_t utc_us);
  /// Tries once more to write the lines of the history that a full disk kept back. One thread.
  void retry_history();
  /// Lines of the history that were given up. Any thread.
  [[nodiscard]] std::int64_t lost_history() const noexcept { return history_->file.lost(); }
  /// Lines of the history that wait for the disk. Any thread.
  [[nodiscard]] std::size_t waiting_history() const noexcept { return history_->waiting; }

  /// errno of the last save, 0 on success. Any thread.
  [[nodiscard]] int error() const noexcept { return *error_; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  struct History {
    History(const std::filesystem::path& path, std::int64_t most_bytes) : file(path, most_bytes) {}
    CappedFile file;
    std::deque<std::string> unwritten;    ///< the writer's thread alone
    std::atomic<std::size_t> waiting{0};  ///< size of `unwritten`
  };
  static void write(History& history);
  void append(const std::string& line);
  void append(const std::string& line, std::int64_t utc_us);

  std::filesystem::path file_;
  std::string rig_id_;
  BackgroundWriter& writer_;
  std::shared_ptr<History> history_;
  std::map<std::string, std::string> noted_;  ///< newest line of each alarm, without its time
  std::uint64_t saved_ = 0;                   ///< AlarmBook::changes() at the last save
  std::shared_ptr<std::atomic<int>> error_ =
      std::make_shared<std::atomic<int>>(0);  ///< shared with the jobs
};

/// Writes the file under a temporary name beside it, synchronises and renames it; 0 or errno.
[[nodiscard]] int write_durably(const std::filesystem::path& file,
                                const std::string& text) noexcept;

}  // namespace monitor::io
