#include "config/record/time_grid.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/schema/error.h"

namespace config::record {
namespace {

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

/// Sorts `values` as far as it needs.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

TimeGrid find_grid(const std::vector<double>& t_s,
                   const std::function<std::string(std::size_t)>& where) {
  using schema::bad_data;
  if (t_s.size() < 3) throw bad_data(where(0), "has fewer than 3 samples");
  std::vector<double> steps(t_s.size() - 1);
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    steps[i - 1] = t_s[i] - t_s[i - 1];
    if (!(steps[i - 1] > 0.0)) throw bad_data(where(i), "time does not increase");
  }
  const double median_s = median(steps);

  TimeGrid grid;
  double periods = 0.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double ratio = (t_s[i] - t_s[i - 1]) / median_s;
    const double whole = std::round(ratio);
    const double allowed = std::min(0.5, kJitter + kMedianError * (whole - 1.0));
    if (whole < 1.0 || std::abs(ratio - whole) > allowed) {
      throw bad_data(where(i), "is unevenly sampled: a step of " + in_ms(t_s[i] - t_s[i - 1]),
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

namespace {

/// Greatest error of a time within its period.
constexpr double kLargestJitter = 0.5;
/// Greatest error in ticks of the clock that rounded the times: half a tick, and the grid's own.
constexpr double kLargestRounding = 0.75;
constexpr std::size_t kFewestForNominal = 10;
/// Rows within whole ticks of a clock that several share, for an error of the rate below 0.25 %.
constexpr double kFewestInTicks = 400.0;

/// Rows with one time.
struct Tick {
  std::size_t first = 0;
  std::size_t rows = 0;
};

/// The ticks that several rows share, without those that the record's ends or gaps cut off.
std::vector<Tick> whole_ticks(const std::vector<double>& t_s, double tick_s) {
  constexpr double kNext = 1.5;
  std::vector<Tick> ticks;
  bool whole = false;
  for (std::size_t first = 0; first < t_s.size();) {
    std::size_t end = first + 1;
    while (end < t_s.size() && t_s[end] == t_s[first]) ++end;
    const bool next = end < t_s.size() && t_s[end] - t_s[first] < kNext * tick_s;
    if (whole && next) ticks.push_back({first, end - first});
    whole = next;
    first = end;
  }
  return ticks;
}

std::size_t usual_rows(const std::vector<Tick>& ticks) {
  std::vector<std::size_t> rows;
  rows.reserve(ticks.size());
  for (const Tick& tick : ticks) rows.push_back(tick.rows);
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
  std::nth_element(rows.begin(), middle, rows.end());
  return *middle;
}

/// The first tick whose rows differ from the usual number by more than the beat between rows and
/// ticks makes them; none: they are lost nowhere, or one at a time.
std::optional<Tick> uneven_tick(const std::vector<Tick>& ticks) {
  if (ticks.empty()) return std::nullopt;
  const std::size_t usual = usual_rows(ticks);
  const auto odd = std::find_if(ticks.begin(), ticks.end(), [&](const Tick& tick) {
    return tick.rows + 1 < usual || tick.rows > usual + 1;
  });
  return odd == ticks.end() ? std::nullopt : std::optional(*odd);
}

/// The mean period over whole ticks, as 3.125 rows a tick are 3 or 4. 0: too few rows, or some are
/// lost.
double period_in_ticks(const std::vector<Tick>& ticks, double tick_s) {
  double rows = 0.0;
  for (const Tick& tick : ticks) rows += static_cast<double>(tick.rows);
  if (rows < kFewestInTicks || uneven_tick(ticks)) return 0.0;
  return static_cast<double>(ticks.size()) * tick_s / rows;
}

/// The tick of a clock that all steps are whole numbers of; 0: none is coarse enough to matter.
double tick_of(const std::vector<double>& t_s, double mean_step_s) {
  double least_s = 0.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double step_s = t_s[i] - t_s[i - 1];
    if (step_s > 0.01 * mean_step_s && (least_s == 0.0 || step_s < least_s)) least_s = step_s;
  }
  // The tick itself need not occur as a step: steps of 3 and 4 ms are ticks of 1 ms.
  for (int parts = 1; parts <= 64; ++parts) {
    const double tick_s = least_s / parts;
    bool whole = tick_s > 0.0;
    for (std::size_t i = 1; whole && i < t_s.size(); ++i) {
      const double ratio = (t_s[i] - t_s[i - 1]) / tick_s;
      whole = std::abs(ratio - std::round(ratio)) < 1e-3;
    }
    if (whole) return tick_s;
  }
  return 0.0;
}

/// The clock that rounded the times.
struct Clock {
  double tick_s = 0.0;    ///< 0: none is coarse enough to matter
  double period_s = 0.0;  ///< period of the samples, about
  bool several_a_tick = false;
};

/// None where times go back, stand still throughout or are few. `steps`: those of `t_s`.
std::optional<Clock> find_clock(const std::vector<double>& t_s, std::vector<double>& steps) {
  const std::size_t n = t_s.size();
  if (n < kFewestForNominal) return std::nullopt;
  steps.resize(n - 1);
  for (std::size_t i = 1; i < n; ++i) {
    steps[i - 1] = t_s[i] - t_s[i - 1];
    if (!(steps[i - 1] >= 0.0) || !std::isfinite(steps[i - 1])) return std::nullopt;
  }
  const double mean_s = (t_s.back() - t_s.front()) / static_cast<double>(n - 1);
  Clock clock;
  clock.tick_s = tick_of(t_s, mean_s);
  const double median_s = median(steps);
  // The mean of the steps that are no gaps; a coarse clock makes some of them 0.
  const double longest_s = 2.5 * std::max(median_s, std::min(clock.tick_s, mean_s));
  double sum_s = 0.0;
  double count = 0.0;
  for (const double step_s : steps) {
    if (step_s > std::max(longest_s, 1.5 * clock.tick_s)) continue;
    sum_s += step_s;
    count += 1.0;
  }
  clock.period_s = sum_s / count;
  if (!(clock.period_s > 0.0)) return std::nullopt;
  clock.several_a_tick = clock.tick_s >= 1.05 * clock.period_s;
  return clock;
}

}  // namespace

bool share_ticks(const std::vector<double>& t_s) {
  constexpr double kSeveral = 1.5;
  if (t_s.size() < kFewestForNominal) return false;
  double ticks = 1.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (!(t_s[i] >= t_s[i - 1])) return false;
    if (t_s[i] > t_s[i - 1]) ticks += 1.0;
  }
  return static_cast<double>(t_s.size()) >= kSeveral * ticks;
}

std::optional<UnevenTick> find_uneven_tick(const std::vector<double>& t_s) {
  std::vector<double> steps;
  const std::optional<Clock> clock = find_clock(t_s, steps);
  if (!clock || !clock->several_a_tick) return std::nullopt;
  const std::vector<Tick> ticks = whole_ticks(t_s, clock->tick_s);
  const std::optional<Tick> odd = uneven_tick(ticks);
  if (!odd) return std::nullopt;
  return UnevenTick{odd->first, odd->rows, usual_rows(ticks), clock->tick_s};
}

std::optional<NominalGrid> find_nominal_grid(const std::vector<double>& t_s) {
  const std::size_t n = t_s.size();
  std::vector<double> steps;
  const std::optional<Clock> clock = find_clock(t_s, steps);
  if (!clock) return std::nullopt;
  const double tick_s = clock->tick_s;
  const bool several_a_tick = clock->several_a_tick;
  double period_s = clock->period_s;
  // Steps of one tick and of two may be times rounded, or samples lost: nothing tells which.
  if (!several_a_tick && tick_s > 0.0 && period_s < 1.95 * tick_s) return std::nullopt;
  if (!several_a_tick && *std::min_element(steps.begin(), steps.end()) <= 0.0) return std::nullopt;

  if (several_a_tick) period_s = period_in_ticks(whole_ticks(t_s, tick_s), tick_s);
  if (!(period_s > 0.0)) return std::nullopt;

  NominalGrid result;
  std::vector<double> index(n, 0.0);
  double begin_s = t_s.front();
  for (int pass = 0; pass < 3; ++pass) {
    result.grid.gaps.clear();
    double expected_s = t_s.front();
    for (std::size_t i = 1; i < n; ++i) {
      const double step_s = t_s[i] - t_s[i - 1];
      double periods = 1.0;
      if (several_a_tick) {
        if (step_s > 1.5 * tick_s) periods = std::max(1.0, std::round(step_s / period_s));
      } else {
        // Against the grid so far, so that the errors of two neighbours do not add up; at first a
        // grid that follows the times slowly.
        constexpr double kFollowing = 0.1;
        if (pass > 0) expected_s = begin_s + index[i - 1] * period_s;
        periods = std::max(1.0, std::round((t_s[i] - expected_s) / period_s));
        expected_s += periods * period_s;
        expected_s += kFollowing * (t_s[i] - expected_s);
      }
      index[i] = index[i - 1] + periods;
      if (periods > 1.0) result.grid.gaps.push_back(i);
    }
    // The straight line through (index, t), least squares about the means.
    double mean_index = 0.0;
    double mean_t_s = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      mean_index += index[i] / static_cast<double>(n);
      mean_t_s += (t_s[i] - t_s.front()) / static_cast<double>(n);
    }
    double covariance = 0.0;
    double variance = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      covariance += (index[i] - mean_index) * (t_s[i] - t_s.front() - mean_t_s);
      variance += (index[i] - mean_index) * (index[i] - mean_index);
    }
    if (!several_a_tick) period_s = covariance / variance;
    if (!(period_s > 0.0)) return std::nullopt;
    begin_s = t_s.front() + mean_t_s - period_s * mean_index;
  }
  if (!(period_s > 0.0)) return std::nullopt;
  const double allowed_s = std::max(kLargestJitter * period_s, kLargestRounding * tick_s);
  result.t_s.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    result.t_s[i] = begin_s + index[i] * period_s;
    result.largest_error_s = std::max(result.largest_error_s, std::abs(t_s[i] - result.t_s[i]));
  }
  if (result.largest_error_s > allowed_s) return std::nullopt;
  if (result.grid.gaps.size() > 1 && result.grid.gaps.size() * kStepsPerGap > n - 1) {
    return std::nullopt;
  }
  result.grid.sample_time_s = period_s;
  return result;
}

}  // namespace config::record
