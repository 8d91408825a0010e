// Persists alarm states across a restart in FOLDER/alarms.json, written in the background and
// replaced atomically. Shelving keeps its wall-clock end, so time while the daemon is down counts.
// FOLDER/history.log keeps every change of an alarm, one JSON line each, and starts and ends of the
// daemon, for `spoolwatch alarms --statistics`.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/io/background_writer.h"
#include "daemon/io/capped_file.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::io {

/// Source and name of the alarm on lines of the history that were given up.
inline constexpr const char* kHistoryLost[] = {"alarms", "history_lost"};

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
  /// Posts what finish() does, without waiting for it.
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
  /// Writes the daemon's end and the lines that wait, within about `most_time`. Returns the lines
  /// that are not in the history. Call last; blocks on the disk.
  std::int64_t finish(std::chrono::milliseconds most_time = kLongestEnd);
  /// Lines of the history that were given up, without those of kHistoryLost: the alarm on this
  /// number must not raise itself. Any thread.
  [[nodiscard]] std::int64_t lost_history() const noexcept { return history_->file.lost(); }
  /// Lines of the history that wait for the disk. Any thread.
  [[nodiscard]] std::size_t waiting_history() const noexcept { return history_->waiting; }

  /// errno of the last save, 0 on success. Any thread.
  [[nodiscard]] int error() const noexcept { return *error_; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] const std::filesystem::path& history_file() const noexcept {
    return history_->file.path();
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// Well below the time after which systemd kills a daemon that stops.
  static constexpr std::chrono::milliseconds kLongestEnd{3000};
  /// Lines written together, synchronised once, so that other jobs of the writer do not wait long.
  static constexpr std::size_t kMostAtOnce = 500;

  struct History {
    History(const std::filesystem::path& path, std::int64_t most_bytes) : file(path, most_bytes) {}
    CappedFile file;
    std::deque<std::string> unwritten;    ///< the writer's thread alone
    std::size_t at_once = kMostAtOnce;    ///< fewer lines on a disk that is nearly full; likewise
    std::atomic<std::size_t> waiting{0};  ///< size of `unwritten`
  };
  /// Writes `most` of the oldest lines together, or as many as the disk takes; returns how many.
  static std::size_t write_some(History& history, std::size_t most);
  /// Writes lines until `most` are written, one cannot be, or `until` has passed.
  static void write(History& history, std::size_t most = kMostAtOnce,
                    Clock::time_point until = Clock::time_point::max());
  /// `counts`: a line that is given up for this one, or this one itself, is a lost one.
  static void add(History& history, const std::string& line, bool counts = true);
  void append(const std::string& line, std::int64_t utc_us, bool counts = true);
  bool post_end(std::chrono::milliseconds most_time, std::function<void()> done);

  std::filesystem::path file_;
  std::string rig_id_;
  BackgroundWriter& writer_;
  std::shared_ptr<History> history_;
  std::map<std::string, std::string> noted_;  ///< newest line of each alarm, without its time
  std::uint64_t saved_ = 0;                   ///< AlarmBook::changes() at the last save
  bool ended_ = false;
  std::shared_ptr<std::atomic<int>> error_ =
      std::make_shared<std::atomic<int>>(0);  ///< shared with the jobs
};

/// Writes the file under a temporary name beside it, synchronises and renames it; 0 or errno.
[[nodiscard]] int write_durably(const std::filesystem::path& file,
                                const std::string& text) noexcept;

}  // namespace monitor::io
