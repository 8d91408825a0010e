#include "workbench/compare/region_spans.h"

#include <algorithm>
#include <cmath>

namespace workbench::compare {
namespace {

namespace validation = estimator::greybox::validation;

constexpr double kJoined_s = 0.1;

bool within(const validation::Bin& bin, const validation::RegionRange& range) {
  if (!range.name.empty()) return bin.name == range.name;
  const double slack = 1e-9 * std::max(std::abs(range.from), std::abs(range.to));
  return bin.from >= range.from - slack && bin.to <= range.to + slack;
}

/// Clears the samples outside `range`.
void narrow(const validation::Comparison& comparison, const validation::RegionRange& range,
            std::vector<char>& in) {
  for (const validation::Region& region : comparison.regions) {
    if (region.variable != range.variable) continue;
    for (std::size_t k = 0; k < in.size(); ++k) {
      const int bin = region.bin_of[k];
      if (bin < 0 || !within(region.bins[static_cast<std::size_t>(bin)], range)) in[k] = 0;
    }
  }
}

}  // namespace

std::vector<TimeSpan> region_spans(const validation::Comparison& comparison,
                                   const validation::SignificantRegion& region, std::size_t most) {
  const std::vector<double>& t_s = comparison.record.t_s;
  std::vector<char> in(t_s.size(), 1);
  for (const validation::RegionRange& range : region.ranges) narrow(comparison, range, in);
  std::vector<TimeSpan> spans;
  for (std::size_t k = 0; k < in.size(); ++k) {
    if (in[k] == 0) continue;
    if (!spans.empty() && t_s[k] - spans.back().to_s < kJoined_s) {
      spans.back().to_s = t_s[k];
    } else {
      spans.push_back({t_s[k], t_s[k]});
    }
  }
  if (spans.size() <= most) return spans;
  const auto longer = [](const TimeSpan& a, const TimeSpan& b) {
    return a.to_s - a.from_s > b.to_s - b.from_s;
  };
  std::nth_element(spans.begin(), spans.begin() + static_cast<std::ptrdiff_t>(most), spans.end(),
                   longer);
  spans.resize(most);
  std::sort(spans.begin(), spans.end(),
            [](const TimeSpan& a, const TimeSpan& b) { return a.from_s < b.from_s; });
  return spans;
}

}  // namespace workbench::compare
