// Which column of a foreign file is time, command and position, by the words and units of its
// header or by a mapping (reading.h). What cannot be told for certain is an error with the mapping
// that would probably be right, never a guess.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/record/reading.h"
#include "config/record/unit_text.h"

namespace config::record {

/// One column of a file, before it is known what it means.
struct FileColumn {
  std::string header;  ///< as in the file; empty: the file has no header
  std::string unit;    ///< from a line of units or an attribute; empty: none
  std::string factor;  ///< "has 'Factor' 0.001 in line 3": stated above the numbers; empty: none
  bool numbers = true;
  bool setting = false;        ///< its numbers with units hardly differ: perhaps no measurement
  bool clock = false;          ///< date and time, or time of day: already in s
  std::vector<double> sample;  ///< some of its first values
};

struct FileHead {
  std::string where;  ///< "file:line" of the header
  std::vector<FileColumn> columns;
  double step_s = 0.0;         ///< sampling period that the file states; 0: none
  double stated_step_s = 0.0;  ///< likewise, good enough for a proposal alone
  bool time_in_s = false;      ///< a time without a unit is in s (the format says so)
  bool variables = false;      ///< "variable" instead of "column" in messages
  std::string more;            ///< what else the file has, for the list of columns
};

enum class Role { time, command, position, further };

/// One column on its way into a record: SI value = factor * value in the file + offset.
struct Channel {
  std::size_t column = 0;  ///< number in the file, from 0
  Role role = Role::further;
  std::string name;       ///< in the record: "t_s", "u_V", "y_m", "supply_pressure_Pa"
  std::string unit_text;  ///< as in the file or in the mapping
  double factor = 1.0;
  double offset = 0.0;
  std::size_t times = kSharedTimes;  ///< column of this channel's own times

  static constexpr std::size_t kSharedTimes = static_cast<std::size_t>(-1);
};

struct Layout {
  std::vector<Channel> channels;   ///< in the order of the file
  double step_s = 0.0;             ///< above 0: there is no time column, rows follow at this period
  std::string command_unit = "V";  ///< ending of the command's name: "V", "A", "pct", "N", ...
  std::string position_unit = "m";  ///< likewise

  [[nodiscard]] const Channel* of(Role role) const noexcept;
};

/// Headers t_s, u_V, y_m, ... (layout.h) are taken as they always were. Throws schema::DataError
/// at head.where with everything that is wrong.
/// `position_optional`: a file without a column for the position has a layout too.
[[nodiscard]] Layout understand(const FileHead& head, const std::vector<MapEntry>& map,
                                bool position_optional = false);

}  // namespace config::record
