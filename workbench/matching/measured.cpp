#include "workbench/matching/measured.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/error.h"

namespace workbench::matching {
namespace {

constexpr double kLeast_s = 2.0;
/// Two samples at least while a segment settles.
constexpr double kSlowest_s = 0.25;

void append(Measured& to, const config::record::Record& from, std::size_t begin, std::size_t end) {
  const auto settling = static_cast<std::size_t>(std::lround(kSettling_s / from.sample_time_s));
  to.starts.push_back(to.size());
  for (std::size_t i = begin; i < end; ++i) {
    to.t_s.push_back(from.t_s[i]);
    to.u_V.push_back(from.u_V[i]);
    to.y_m.push_back(from.y_m[i]);
    to.settled.push_back(i - begin >= settling ? 1 : 0);
  }
}

std::string seconds(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", s);
  return text;
}

}  // namespace

Measured measured(const config::record::Record& record) {
  Measured result;
  result.name = record.name;
  result.sample_time_s = record.sample_time_s;
  result.notes = record.notes;
  if (record.sample_time_s > kSlowest_s) {
    throw config::schema::bad_data(record.name, "is sampled every " + seconds(record.sample_time_s),
                                   "every " + seconds(kSlowest_s) + " or faster");
  }
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest_s / record.sample_time_s));
  std::size_t left_out = 0;
  std::size_t longest = 0;
  for (std::size_t i = 0; i <= record.gaps.size(); ++i) {
    const std::size_t begin = i == 0 ? 0 : record.gaps[i - 1];
    const std::size_t end = i == record.gaps.size() ? record.size() : record.gaps[i];
    longest = std::max(longest, end - begin);
    if (end - begin >= shortest) {
      append(result, record, begin, end);
    } else {
      left_out += end - begin;
    }
  }
  if (!record.gaps.empty()) {
    result.notes.push_back(std::to_string(record.gaps.size()) + " gaps: the model starts anew in " +
                           std::to_string(result.starts.size()) + " segments");
  }
  if (left_out > 0) {
    result.notes.push_back(std::to_string(left_out) + " samples in segments shorter than " +
                           seconds(kShortest_s) + " are left out");
  }
  const double length_s = static_cast<double>(result.size()) * result.sample_time_s;
  if (length_s < kLeast_s) {
    const std::string all = seconds(static_cast<double>(record.size()) * record.sample_time_s);
    const std::string what =
        record.gaps.empty()
            ? "is too short: " + all
            : "is too short: of " + all + " in " + std::to_string(record.gaps.size() + 1) +
                  " segments, the longest " +
                  seconds(static_cast<double>(longest) * record.sample_time_s) + ", " +
                  seconds(length_s) + " are in segments of " + seconds(kShortest_s) + " or more";
    throw config::schema::bad_data(record.name, what, "at least " + seconds(kLeast_s));
  }
  return result;
}

Measured part(const Measured& whole, std::size_t from, std::size_t to) {
  Measured result;
  result.name = whole.name;
  result.sample_time_s = whole.sample_time_s;
  const auto cut = [&](const auto& values) {
    return std::decay_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                          values.begin() + static_cast<std::ptrdiff_t>(to));
  };
  result.t_s = cut(whole.t_s);
  result.u_V = cut(whole.u_V);
  result.y_m = cut(whole.y_m);
  result.settled = cut(whole.settled);
  result.starts = {0};
  for (const std::size_t start : whole.starts) {
    if (start > from && start < to) result.starts.push_back(start - from);
  }
  const auto settling = static_cast<std::size_t>(std::lround(kSettling_s / whole.sample_time_s));
  for (std::size_t i = 0; i < std::min(settling, result.size()); ++i) result.settled[i] = 0;
  return result;
}

}  // namespace workbench::matching
