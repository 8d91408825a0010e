// The even grid of sampling times behind a column of times.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace config::record {

struct TimeGrid {
  double sample_time_s = 0.0;
  std::vector<std::size_t> gaps;  ///< index of the first sample after each gap
};

/// The period is the median step, refined over the whole record. Throws schema::DataError
/// at `where(index)` when time does not increase or a step is no whole number of periods within 15
/// % of a period, and when more than a tenth of all steps are gaps.
[[nodiscard]] TimeGrid find_grid(const std::vector<double>& t_s,
                                 const std::function<std::string(std::size_t)>& where);

/// Times on an even grid, in place of times that were rounded to a coarse clock or jitter.
struct NominalGrid {
  TimeGrid grid;
  std::vector<double> t_s;
  double largest_error_s = 0.0;  ///< by which a given time misses the grid
};

/// None where times go back or miss every even grid by more than half a period (by more than the
/// clock's resolution where that is coarser), or where more than a tenth of all steps are gaps.
/// Where several samples fall within one tick of the clock, a lost one cannot be seen.
[[nodiscard]] std::optional<NominalGrid> find_nominal_grid(const std::vector<double>& t_s);

}  // namespace config::record
