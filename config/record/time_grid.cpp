#include "config/record/time_grid.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

/// Share of a period by which a step may miss the grid: time stamps rounded to 1 ms at 130 Hz do so
/// by up to 0.125.
constexpr double kJitter = 0.15;
/// Relative error of the median step that a long gap multiplies.
constexpr double kMedianError = 1e-3;
constexpr std::size_t kStepsPerGap = 10;

std::string in_ms(double time_s) {
  std::ostringstream out;
  out << time_s * 1e3 << " ms";
  return out.str();
}

}  // namespace

TimeGrid find_grid(const std::vector<double>& t_s,
                   const std::function<std::string(std::size_t)>& where) {
  if (t_s.size() < 3) throw bad_data(where(0), "has fewer than 3 samples");
  std::vector<double> steps(t_s.size() - 1);
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    steps[i - 1] = t_s[i] - t_s[i - 1];
    if (!(steps[i - 1] > 0.0)) throw bad_data(where(i), "time does not increase");
  }
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median_s = *middle;

  TimeGrid grid;
  double periods = 0.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double ratio = steps[i - 1] / median_s;
    const double whole = std::round(ratio);
    const double allowed = std::min(0.5, kJitter + kMedianError * (whole - 1.0));
    if (whole < 1.0 || std::abs(ratio - whole) > allowed) {
      throw bad_data(where(i), "is unevenly sampled: a step of " + in_ms(steps[i - 1]),
                     "whole numbers of the median step, " + in_ms(median_s));
    }
    if (whole > 1.0) grid.gaps.push_back(i);
    periods += whole;
  }
  if (grid.gaps.size() * kStepsPerGap > steps.size() && grid.gaps.size() > 1) {
    throw bad_data(where(grid.gaps.front()),
                   "is unevenly sampled: " + std::to_string(grid.gaps.size()) + " of " +
                       std::to_string(steps.size()) + " steps are longer than the median step, " +
                       in_ms(median_s));
  }
  grid.sample_time_s = (t_s.back() - t_s.front()) / periods;
  return grid;
}

}  // namespace config::record
