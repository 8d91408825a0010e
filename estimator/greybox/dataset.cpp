#include "estimator/greybox/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/record/record.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"
#include "estimator/greybox/innovation_gains.h"

namespace estimator::greybox {
namespace {

/// Limit of the correction in one sample, where samples are far apart.
constexpr double kLargestInitialisationGain = 0.5;
constexpr double kLeast_s = 2.0;
/// At least two samples fall in the settling time of a segment.
constexpr double kSlowest_s = 0.5;

/// Ratio of the speed at a record's first sample to its RMS speed above which the record begins
/// during a motion. A start from rest under a command stays below a few per cent.
constexpr double kMoving = 0.05;

std::size_t settling_samples(double sample_time_s) {
  return static_cast<std::size_t>(std::lround(kSettling_s / sample_time_s));
}

/// Segment [begin, end); the speed at its start is that of a parabola through three samples.
bool begins_moving(const config::record::Record& record, std::size_t begin, std::size_t end) {
  if (end - begin < 3) return true;
  const double* y_m = &record.y_m[begin];
  const double first_m = 0.5 * (-3.0 * y_m[0] + 4.0 * y_m[1] - y_m[2]);
  double squares = 0.0;
  for (std::size_t i = begin + 1; i < end; ++i) {
    squares += (record.y_m[i] - record.y_m[i - 1]) * (record.y_m[i] - record.y_m[i - 1]);
  }
  return std::abs(first_m) > kMoving * std::sqrt(squares / static_cast<double>(end - begin - 1));
}

void append(Dataset& to, const config::record::Record& from, std::size_t begin, std::size_t end) {
  const std::size_t settling = settling_samples(from.sample_time_s);
  const Initialisation initialising = begin > 0                         ? kInitialising
                                      : begins_moving(from, begin, end) ? kInitialisingIfObserved
                                                                        : kFromRest;
  to.starts.push_back(to.size());
  for (std::size_t i = begin; i < end; ++i) {
    to.t_s.push_back(from.t_s[i]);
    to.u_V.push_back(from.u_V[i]);
    to.y_m.push_back(from.y_m[i]);
    const bool valid = i - begin >= settling;
    to.valid.push_back(valid ? 1 : 0);
    to.initialising.push_back(valid ? kNotInitialising : initialising);
  }
}

std::string seconds(double s) { return fmt::format("{:.3g} s", s); }

/// Beyond these no rig moves and no drive commands.
constexpr double kFarthest_m = 1e6;
constexpr double kGreatest_V = 1e9;

/// Throws for a value that no rig has: one would make every sum of squares useless.
void refuse_spikes(const config::record::Record& record, const std::vector<double>& values,
                   double most, const char* what, const char* unit) {
  std::size_t spikes = 0;
  std::size_t first = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(values[k]) <= most) continue;
    if (spikes++ == 0) first = k;
  }
  if (spikes == 0) return;
  throw config::schema::bad_data(
      record.name,
      fmt::format("has a spike at {:.6g} s: {} {:.3g} {}, and {} more such samples",
                  record.t_s[first], what, values[first], unit, spikes - 1),
      fmt::format("up to {:.0e} {}; leave the field empty where nothing was measured", most, unit));
}

/// Samples of a record without a gap: [begin, end).
struct Segment {
  std::size_t begin;
  std::size_t end;
};

std::vector<Segment> segments_of(const config::record::Record& record) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i <= record.gaps.size(); ++i) {
    segments.push_back({i == 0 ? 0 : record.gaps[i - 1],
                        i == record.gaps.size() ? record.size() : record.gaps[i]});
  }
  return segments;
}

}  // namespace

double Dataset::observer_gain(std::size_t k, double observer_per_s) const noexcept {
  const double observed = observer_per_s * sample_time_s;
  if (k >= initialising.size() || initialising[k] <= kFromRest) return observed;
  if (initialising[k] == kInitialisingIfObserved && !(observer_per_s > 0.0)) return observed;
  return std::max(observed,
                  std::min(kLargestInitialisationGain, kInitialisation_per_s * sample_time_s));
}

ObserverGain Dataset::observer_gain(std::size_t k, double observer_per_s,
                                    PlantStart start) const noexcept {
  const bool settles = k < initialising.size() && initialising[k] != kNotInitialising;
  const bool follows = observer_per_s > 0.0 || (settles && initialising[k] == kInitialising);
  if (start == PlantStart::held_by_oil || !settles || !follows) {
    return {observer_gain(k, observer_per_s), 0.0};
  }
  const auto next = std::upper_bound(starts.begin(), starts.end(), k);
  const std::size_t begin = next == starts.begin() ? 0 : *(next - 1);
  const auto n = static_cast<double>(k - begin + 1);
  const double all = n * (n + 1.0);
  // one sample shows no speed
  return {2.0 * (2.0 * n - 1.0) / all, n > 1.0 ? 6.0 / all / sample_time_s : 0.0};
}

Dataset dataset_of(const config::record::Record& record) {
  Dataset result;
  result.name = record.name;
  result.sample_time_s = record.sample_time_s;
  result.notes = record.notes;
  result.command_is_interpolated = record.command_is_interpolated;
  for (const config::record::ChannelOrigin& origin : record.origins) {
    if (origin.name == "u_" + record.command_unit) {
      const double by_unit = config::record::parse_unit(origin.unit).factor;
      result.command_column = {origin.header, origin.unit, origin.factor < 0.0,
                               std::abs(origin.factor) != by_unit};
    } else if (origin.name == "y_" + record.position_unit) {
      result.position_column = {origin.header, origin.unit, origin.factor < 0.0};
    }
  }
  if (record.sample_time_s > kSlowest_s) {
    throw config::schema::bad_data(record.name, "is sampled every " + seconds(record.sample_time_s),
                                   "every " + seconds(kSlowest_s) + " or faster");
  }
  refuse_spikes(record, record.y_m, kFarthest_m, "position", "m");
  refuse_spikes(record, record.u_V, kGreatest_V, "command", "V");
  const std::vector<Segment> segments = segments_of(record);
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest_s / record.sample_time_s));
  std::size_t left_out = 0;
  std::size_t longest = 0;
  for (const auto& [begin, end] : segments) {
    longest = std::max(longest, end - begin);
    if (end - begin >= shortest) {
      append(result, record, begin, end);
    } else {
      left_out += end - begin;
    }
  }
  result.gaps = {std::max<std::size_t>(1, segments.size()) - 1, result.starts.size(), left_out};
  const double length_s = static_cast<double>(result.size()) * result.sample_time_s;
  if (length_s < kLeast_s) {
    const std::string all = seconds(static_cast<double>(record.size()) * record.sample_time_s);
    const std::string what =
        segments.size() < 2
            ? "is too short: " + all
            : "is too short: of " + all + " in " + std::to_string(segments.size()) +
                  " segments, the longest " +
                  seconds(static_cast<double>(longest) * record.sample_time_s) + ", " +
                  seconds(length_s) + " are in segments of " + seconds(kShortest_s) + " or more";
    const std::string why = record.left_out.empty() ? "" : "; " + record.left_out;
    throw config::schema::bad_data(record.name, what + why, "at least " + seconds(kLeast_s));
  }
  return result;
}

Dataset dataset_of(double sample_time_s, const std::vector<double>& u_V,
                   const std::vector<double>& y_m) {
  Dataset result;
  result.sample_time_s = sample_time_s;
  result.u_V = u_V;
  result.y_m = y_m;
  result.starts = {0};
  const std::size_t settling = settling_samples(sample_time_s);
  for (std::size_t i = 0; i < y_m.size(); ++i) {
    result.t_s.push_back(sample_time_s * static_cast<double>(i));
    result.valid.push_back(i >= settling ? 1 : 0);
    result.initialising.push_back(i >= settling ? kNotInitialising : kInitialising);
  }
  return result;
}

Dataset part(const Dataset& whole, std::size_t from, std::size_t to) {
  Dataset result;
  result.name = whole.name;
  result.command_column = whole.command_column;
  result.position_column = whole.position_column;
  result.sample_time_s = whole.sample_time_s;
  result.command_is_interpolated = whole.command_is_interpolated;
  const auto cut = [&](const auto& values) {
    return std::decay_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                          values.begin() + static_cast<std::ptrdiff_t>(to));
  };
  result.t_s = cut(whole.t_s);
  result.u_V = cut(whole.u_V);
  result.y_m = cut(whole.y_m);
  result.valid = cut(whole.valid);
  if (whole.innovations) {
    result.innovations = std::make_shared<const InnovationGains>(
        whole.innovations->part(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to)));
  }
  if (!whole.initialising.empty()) result.initialising = cut(whole.initialising);
  result.starts = {0};
  for (const std::size_t start : whole.starts) {
    if (start > from && start < to) result.starts.push_back(start - from);
  }
  if (from == 0) return result;
  result.initialising.resize(result.size());
  for (std::size_t i = 0; i < std::min(settling_samples(whole.sample_time_s), result.size()); ++i) {
    result.valid[i] = 0;
    result.initialising[i] = kInitialising;
  }
  return result;
}

}  // namespace estimator::greybox
