// Alarm quality by the figures of ANSI/ISA-18.2 and EEMUA 191, from the history that the daemon
// keeps in [alarms] folder (daemon/io/alarm_store.h), across its restarts.
//
// An annunciation is a change of an alarm that is not shelved from normal to active. Rates count
// the time in which a daemon ran.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace workbench::control {

struct AlarmEvent {
  std::int64_t utc_us = 0;
  std::string event;  ///< "start" and "end" of the daemon; empty: a change of `alarm`
  std::string alarm{};
  std::string severity{};
  std::string state{};
  bool active = false;
};

struct AlarmHistory {
  std::string folder;
  std::vector<AlarmEvent> events{};  ///< in order of time
  std::size_t damaged_lines = 0;
};

/// Throws config::schema::RunError when there is no history.
[[nodiscard]] AlarmHistory read_history(const std::filesystem::path& folder);

struct AlarmStatistics {
  using Counts = std::vector<std::pair<std::string, std::int64_t>>;  ///< the greatest first

  std::string folder;
  std::int64_t from_utc_us = 0;
  std::int64_t to_utc_us = 0;
  double observed_s = 0.0;
  std::int64_t annunciations = 0;
  double per_hour = 0.0;
  std::int64_t most_in_10_min = 0;
  double flood_ratio = 0.0;  ///< share of the time with more than ten in the ten minutes before
  Counts frequent{};         ///< annunciations by alarm
  Counts severities{};
  Counts chattering{};  ///< the most within 60 s, where three or more
  std::vector<std::string> standing{};
  std::vector<std::string> stale{};  ///< standing for more than a day
  std::size_t damaged_lines = 0;
};

/// `now_utc_us`: the daemon runs until now; 0: until the last line.
[[nodiscard]] AlarmStatistics alarm_statistics(const AlarmHistory& history,
                                               std::int64_t now_utc_us = 0);

[[nodiscard]] std::string to_json(const AlarmStatistics& statistics);
void print_statistics(const AlarmStatistics& statistics, std::ostream& out);

}  // namespace workbench::control
