#include "workbench/diagnose/leaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "config/units/quantity.h"
#include "estimator/greybox/reading_faults.h"
#include "workbench/fit/ignored_spans.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;

namespace {

/// Most of the record's length that the gaps may take, the whole of them and at worst.
constexpr double kMostLost = 0.5;
constexpr double kBesides_s = 1.0;

/// Length that a gap costs: its segment settles anew, and may be too short to keep.
constexpr double kGap_s = greybox::kSettling_s + greybox::kShortest_s;

}  // namespace

greybox::Dataset dataset_without_leaps(const config::record::Record& record) {
  greybox::Dataset data = greybox::dataset_of(record);
  const std::vector<greybox::SampleRange> leaps = greybox::reading_faults(data).leaps;
  const double length_s = static_cast<double>(data.size()) * data.sample_time_s;
  if (leaps.empty() ||
      static_cast<double>(leaps.size()) * kGap_s > kMostLost * (length_s - kBesides_s)) {
    return data;
  }
  std::vector<char> ignored(record.size(), 0);
  std::ptrdiff_t samples = 0;
  for (const greybox::SampleRange& leap : leaps) {
    const auto at = [&](double t_s) {
      return std::lower_bound(record.t_s.begin(), record.t_s.end(), t_s) - record.t_s.begin();
    };
    const std::ptrdiff_t begin = at(data.t_s[leap.begin]);
    const std::ptrdiff_t end = at(data.t_s[leap.end - 1]) + 1;
    std::fill(ignored.begin() + begin, ignored.begin() + end, char{1});
    samples += end - begin;
  }
  config::record::Record rest = record;
  fit::cut_samples(ignored, rest);
  const std::size_t first = leaps.front().begin;
  const std::string what =
      fmt::format("{} of the position {} out of the motion, the first to {} at {:.6g} s: left out",
                  samples == 1 ? "a sample" : fmt::format("{} samples", samples),
                  samples == 1 ? "leaps" : "leap", config::units::length_words(data.y_m[first]),
                  data.t_s[first]);
  data = greybox::dataset_of(rest);
  data.notes.push_back(what);
  return data;
}

}  // namespace workbench::diagnose
