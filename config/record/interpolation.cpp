#include "config/record/interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace config::record {
namespace {

constexpr double kNoReading = std::numeric_limits<double>::quiet_NaN();

/// A hole: no reading within this many periods, or four of the channel's own steps.
double longest_hold_s(const Series& series, double period_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < series.t_s.size(); ++i) {
    steps.push_back(series.t_s[i] - series.t_s[i - 1]);
  }
  if (steps.empty()) return 5.0 * period_s;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return 5.0 * std::max(period_s, *middle);
}

}  // namespace

std::vector<double> held(const Series& series, const EvenGrid& grid, std::vector<char>& hole) {
  std::vector<double> values;
  const double longest_s = longest_hold_s(series, grid.period_s);
  std::size_t i = 0;
  for (std::size_t k = 0; k < grid.t_s.size(); ++k) {
    const double t_s = grid.t_s[k] + 1e-9 * grid.period_s;
    while (i + 1 < series.t_s.size() && series.t_s[i + 1] <= t_s) ++i;
    const bool between = i + 1 < series.t_s.size();
    if (between && series.t_s[i + 1] - series.t_s[i] > longest_s) hole[k] = 1;
    values.push_back(series.values[i]);
  }
  return values;
}

std::vector<double> interpolated(const Series& series, bool main, const EvenGrid& grid,
                                 std::vector<char>& hole) {
  std::vector<double> values;
  const double longest_s = longest_hold_s(series, grid.period_s);
  std::size_t i = 0;
  for (std::size_t k = 0; k < grid.t_s.size(); ++k) {
    const double t_s = grid.t_s[k];
    if (series.t_s.empty()) {
      values.push_back(kNoReading);
      continue;
    }
    while (i + 1 < series.t_s.size() && series.t_s[i + 1] <= t_s) ++i;
    if (i + 1 >= series.t_s.size() || t_s <= series.t_s[i]) {
      const bool at = std::abs(t_s - series.t_s[i]) < grid.period_s;
      values.push_back(at ? series.values[i] : kNoReading);
      continue;
    }
    const double step_s = series.t_s[i + 1] - series.t_s[i];
    const double share = (t_s - series.t_s[i]) / step_s;
    if (step_s > longest_s && main) hole[k] = 1;
    values.push_back(step_s > longest_s && !main
                         ? kNoReading
                         : (1.0 - share) * series.values[i] + share * series.values[i + 1]);
  }
  return values;
}

}  // namespace config::record
