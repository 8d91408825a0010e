#include "estimator/greybox/reading_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimator/greybox/motion_scale.h"

namespace estimator::greybox {
namespace {

constexpr double kLeap = 0.01;       ///< least leap over the usual range
constexpr double kLeapInSteps = 3;   ///< usual largest steps from sample to sample
constexpr double kLeapInTurns = 20;  ///< usual largest distances from the median of five
constexpr double kMostLeaps = 0.01;  ///< share of the samples; more are a motion
/// Share of the samples that are usual: a leap makes two steps.
constexpr double kUsual = 0.97;
constexpr double kLeapInCounts = 4;  ///< steps of the encoder
constexpr double kRounding = 1e-9;   ///< least step of an encoder over the usual range
constexpr double kComesBack = 0.25;  ///< most of the leap that is left behind it
/// Samples before a leap in which a step of the command explains it, and usual largest steps from
/// which on it is one.
constexpr std::size_t kBefore = 4;
constexpr double kCommanded = 3;
constexpr double kTravel = 0.02;  ///< least travel over the usual range
constexpr double kResolutions = 3.0;
constexpr double kCorrelation = 0.4;
constexpr std::size_t kFewestSamples = 3;

bool counts(const Dataset& record, std::size_t k) {
  return k >= record.valid.size() || record.valid[k] != 0;
}

/// From sample to sample of position or command.
std::vector<double> steps_of(const Dataset& record, const std::vector<double>& values) {
  std::vector<double> steps;
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin; k + 1 < span.end; ++k) {
      steps.push_back(std::abs(values[k + 1] - values[k]));
    }
  }
  return steps;
}

/// Distance of each sample from the median of the five about it; 0 at the ends of a segment.
std::vector<double> turns_of(const Dataset& record) {
  std::vector<double> turns_m(record.size(), 0.0);
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin + 2; k + 2 < span.end; ++k) {
      std::array<double, 5> near{};
      std::copy_n(record.y_m.begin() + static_cast<std::ptrdiff_t>(k) - 2, near.size(),
                  near.begin());
      std::nth_element(near.begin(), near.begin() + 2, near.end());
      turns_m[k] = std::abs(record.y_m[k] - near[2]);
    }
  }
  return turns_m;
}

/// The greatest of those that are usual.
double usual(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The least step that is none of rounding: one count of an encoder.
double resolution_m(const std::vector<double>& steps_m, double range_m) {
  double least_m = range_m;
  for (const double step_m : steps_m) {
    if (step_m > kRounding * range_m) least_m = std::min(least_m, step_m);
  }
  return least_m;
}

/// True where the reading comes back to where it left, or where the motion before it would have
/// brought it, and no step of the command came before: a motion overshoots, and a jab is commanded.
/// `usual_V`: usual largest step.
bool is_no_motion(const Dataset& record, const SampleRange& span, const SampleRange& leap,
                  double usual_V) {
  if (leap.begin == span.begin || leap.end == span.end) return false;
  const double left_m = record.y_m[leap.begin - 1];
  const double away_m = std::abs(record.y_m[leap.begin] - left_m);
  const double back_m = record.y_m[leap.end] - left_m;
  // by then a motion has gone on as it did before
  const double before_m = leap.begin > span.begin + 1 ? left_m - record.y_m[leap.begin - 2] : 0.0;
  const double gone_m = static_cast<double>(leap.end - leap.begin + 1) * before_m;
  if (std::min(std::abs(back_m), std::abs(back_m - gone_m)) > kComesBack * away_m) return false;
  const std::size_t from = std::max(span.begin + 1, leap.begin - std::min(leap.begin, kBefore));
  for (std::size_t k = from; k < leap.begin; ++k) {
    if (std::abs(record.u_V[k] - record.u_V[k - 1]) > kCommanded * usual_V) return false;
  }
  return true;
}

/// Speed = offset + gain * command, and their correlation, between the ends of the range.
struct Following {
  double gain = 0.0;        ///< m/s per V
  double offset_mps = 0.0;  ///< a null that the loop holds leaves a command at rest
  double correlation = 0.0;
};

Following following(const Dataset& record, double least_m, double greatest_m) {
  double n = 0.0;
  double u = 0.0;
  double v = 0.0;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin; k + 1 < span.end; ++k) {
      const double at_m = record.y_m[k];
      if (at_m <= least_m || at_m >= greatest_m || !counts(record, k)) continue;
      const double v_mps = (record.y_m[k + 1] - at_m) / record.sample_time_s;
      n += 1.0;
      u += record.u_V[k];
      v += v_mps;
      uu += record.u_V[k] * record.u_V[k];
      uv += record.u_V[k] * v_mps;
      vv += v_mps * v_mps;
    }
  }
  const double spread_u = uu - u * u / n;
  const double spread_v = vv - v * v / n;
  const double both = uv - u * v / n;
  if (!(spread_u > 0.0) || !(spread_v > 0.0)) return {};
  const double gain = both / spread_u;
  return {gain, (v - gain * u) / n, both / std::sqrt(spread_u * spread_v)};
}

/// The least and the greatest position that counts and does not leap.
ValueRange ends_of(const Dataset& record, const std::vector<SampleRange>& leaps) {
  ValueRange ends{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  std::size_t next = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    while (next < leaps.size() && k >= leaps[next].end) ++next;
    if (!counts(record, k) || (next < leaps.size() && k >= leaps[next].begin)) continue;
    ends.low = std::min(ends.low, record.y_m[k]);
    ends.high = std::max(ends.high, record.y_m[k]);
  }
  return ends;
}

std::vector<SampleRange> leaps_of(const Dataset& record, double range_m) {
  const std::vector<double> turns_m = turns_of(record);
  const std::vector<double> steps_m = steps_of(record, record.y_m);
  const double far_m =
      std::max({kLeap * range_m, kLeapInSteps * usual(steps_m), kLeapInTurns * usual(turns_m),
                kLeapInCounts * resolution_m(steps_m, range_m)});
  const double usual_V = usual(steps_of(record, record.u_V));
  std::vector<SampleRange> leaps;
  std::size_t samples = 0;
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin; k < span.end;) {
      SampleRange leap{k, k};
      while (leap.end < span.end && turns_m[leap.end] > far_m) ++leap.end;
      k = std::max(leap.end, leap.begin + 1);
      if (leap.end == leap.begin || !is_no_motion(record, span, leap, usual_V)) continue;
      samples += leap.end - leap.begin;
      leaps.push_back(leap);
    }
  }
  const bool motion =
      static_cast<double>(samples) > kMostLeaps * static_cast<double>(record.size());
  return motion ? std::vector<SampleRange>() : leaps;
}

StuckReading stuck_at(const Dataset& record, double value_m, const Following& moves,
                      double travel_m) {
  StuckReading stuck{value_m, {}};
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin; k < span.end;) {
      const std::size_t begin = k;
      double travelled_m = 0.0;
      double farthest_m = 0.0;
      while (k < span.end && record.y_m[k] == value_m && counts(record, k)) {
        travelled_m += (moves.offset_mps + moves.gain * record.u_V[k]) * record.sample_time_s;
        farthest_m = std::max(farthest_m, std::abs(travelled_m));
        ++k;
      }
      if (k - begin >= kFewestSamples && farthest_m > travel_m) {
        stuck.spans.push_back({begin, k});
      }
      if (k == begin) ++k;
    }
  }
  return stuck;
}

}  // namespace

ReadingFaults reading_faults(const Dataset& record) {
  ReadingFaults faults;
  if (record.size() < 10) return faults;
  const ValueRange most = usual_range(record.y_m);
  const double range_m = most.high - most.low;
  faults.leaps = leaps_of(record, range_m);
  const ValueRange ends = ends_of(record, faults.leaps);
  const Following moves = following(record, ends.low, ends.high);
  if (std::abs(moves.correlation) < kCorrelation) return faults;
  const double count_m = resolution_m(steps_of(record, record.y_m), range_m);
  const double travel_m = std::max(kTravel * range_m, kResolutions * count_m);
  for (const double value_m : {ends.low, ends.high}) {
    StuckReading stuck = stuck_at(record, value_m, moves, travel_m);
    if (!stuck.spans.empty()) faults.stuck.push_back(std::move(stuck));
  }
  return faults;
}

}  // namespace estimator::greybox
