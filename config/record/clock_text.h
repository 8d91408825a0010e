// Dates and times of day as spreadsheets and loggers write them.
#pragma once

#include <string_view>

namespace config::record {

/// Date and time, or time of day, in s since a fixed day, or a duration "0 days 00:00:01.5";
/// `field` without blanks around. False: none.
[[nodiscard]] bool parse_clock(std::string_view field, double& time_s);

}  // namespace config::record
