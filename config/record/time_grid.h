// The sampling period of a column of times, and the samples that are missing from its grid.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace config::record {

/// The sampling grid behind a column of times: its period, and where samples are missing.
struct TimeGrid {
  double sample_time_s = 0.0;
  std::vector<std::size_t> gaps;  ///< index of the first sample after each gap
};

/// The period is the median step, refined over the whole record. Throws schema::DataError
/// at `where(index)` when time does not increase or a step is no whole number of periods within 15
/// % of a period, and when more than a tenth of all steps are gaps.
[[nodiscard]] TimeGrid find_grid(const std::vector<double>& t_s,
                                 const std::function<std::string(std::size_t)>& where);

}  // namespace config::record
