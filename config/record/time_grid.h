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
/// Where several samples fall within one tick of the clock, one that is lost there cannot be seen;
/// where several are, there is no grid (find_uneven_tick).
[[nodiscard]] std::optional<NominalGrid> find_nominal_grid(const std::vector<double>& t_s);

/// True for times that several samples share on average.
[[nodiscard]] bool share_ticks(const std::vector<double>& t_s);

/// A tick of a coarse clock with fewer or more samples than the others.
struct UnevenTick {
  std::size_t first = 0;  ///< index of its first sample
  std::size_t samples = 0;
  std::size_t usual = 0;  ///< samples of most ticks
  double tick_s = 0.0;
};

/// The first tick in which samples are missing, or are too many; ticks beside gaps do not count.
[[nodiscard]] std::optional<UnevenTick> find_uneven_tick(const std::vector<double>& t_s);

}  // namespace config::record
