// How a foreign file becomes a record: which column is what, in which unit, and at which rate.
//
//   t=Time,u="Command [V]",y="-Position*2.5[mm]",supply_pressure=p_s[bar]
//
// A key is t, u, y or the name of a further column. Its value is a column: the header's text, its
// name without the unit, or its number from 1; a minus sign in front, *factor, +offset or -offset,
// and the [unit] of the numbers, where the header names none or another one. u=Cmd@Time2 reads the
// times of one channel from a column of their own. t=1000Hz or t=2ms states the rate of a file
// without times.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::record {

struct ReadOptions {
  std::string map;       ///< key=column,...; or the name of a file with such pairs, one per line
  std::string resample;  ///< empty: not; "auto", or a rate in Hz: interpolate to an even grid
  bool flip_command = false;       ///< turn the command's sign
  double advance_command_s = 0.0;  ///< lead of the command over its log
  bool position_optional = false;  ///< a command alone will do
  std::string channel;             ///< LCM channel; empty: kSampleChannel

  /// True where a record is to be read otherwise than as it stands.
  [[nodiscard]] bool given() const {
    return !map.empty() || !resample.empty() || flip_command || advance_command_s != 0.0;
  }
};

/// Throws schema::UsageError where options are given that the messages of an LCM log cannot follow.
void require_as_logged(const ReadOptions& options, const std::string& log);

struct MapEntry {
  std::string key;     ///< "t", "u", "y", "supply_pressure"
  std::string column;  ///< as typed, without the key
};

/// The pairs of `map`, or of the file that it names. Throws schema::UsageError, and
/// schema::ConfigError for a file without pairs.
[[nodiscard]] std::vector<MapEntry> parse_map(const std::string& map);

/// 0: the rate of the file; above 0: Hz. Throws schema::UsageError.
[[nodiscard]] double parse_resample(const std::string& resample);

}  // namespace config::record
