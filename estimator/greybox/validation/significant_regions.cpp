#include "estimator/greybox/validation/significant_regions.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::validation {
namespace {

/// Least G: above the level of chance over some hundred ranges.
constexpr double kLeastGain = 8.0;
constexpr double kLeastRatio = 1.2;     ///< ratio of the region's RMS to the overall RMS
constexpr double kLeastNoise = 2.0;     ///< ratio of the region's RMS to the sensor's noise
constexpr double kLeastOutside = 0.05;  ///< mean square outside, relative to the overall one
constexpr double kLeastLooks = 4.0;
constexpr double kWidest = 0.5;     ///< share of the time
constexpr double kNarrowing = 1.3;  ///< factor by which a second variable must raise G

double gain(const Bin& in, double all_looks, double all_mean_square) {
  // Where the rod passes often, samples in the region and in the rest alternate.
  const double out = all_looks * std::min(1.0, 2.0 * (1.0 - in.time_share));
  if (in.effective_samples < kLeastLooks || out < kLeastLooks) return 0.0;
  const double out_mean_square =
      all_mean_square * std::max(kLeastOutside, (1.0 - in.local_velocity_error_share) /
                                                    std::max(1e-12, 1.0 - in.time_share));
  const double in_mean_square = in.local_velocity_error_rms_mps * in.local_velocity_error_rms_mps;
  if (!(in_mean_square > out_mean_square) || !(out_mean_square > 0.0)) return 0.0;
  const double pooled = (in.effective_samples * in_mean_square + out * out_mean_square) /
                        (in.effective_samples + out);
  return 0.5 * ((in.effective_samples + out) * std::log(pooled) -
                in.effective_samples * std::log(in_mean_square) - out * std::log(out_mean_square));
}

struct All {
  double length = 1.0;
  double effective_samples = 0.0;
  double mean_square = 0.0;
};

All all_of(const SortedErrors& sorted) {
  All all;
  all.length = correlation_length(sorted);
  const Bin whole = figures(sorted, sorted.counts, all.length);
  all.effective_samples = whole.effective_samples;
  all.mean_square = whole.local_velocity_error_rms_mps * whole.local_velocity_error_rms_mps;
  return all;
}

/// Preference for the more familiar of two variables with about the same G.
constexpr double kAcceleration = 0.8;
constexpr double kVelocity = 0.99;  ///< "below 5 mm/s" before "from -5 to 5 mm/s"

void judge(SignificantRegion& failing, const SortedErrors& sorted, const All& all) {
  const Bin& in = failing.figures;
  failing.gain = gain(in, all.effective_samples, all.mean_square);
  if (failing.ranges.back().variable == "acceleration") failing.gain *= kAcceleration;
  if (failing.ranges.back().variable == "v") failing.gain *= kVelocity;
  const double least_mps =
      std::max(kLeastRatio * std::sqrt(all.mean_square), kLeastNoise * sorted.noise_mps);
  failing.significant = failing.gain > kLeastGain && in.local_velocity_error_rms_mps > least_mps &&
                        in.time_share < kWidest;
}

bool better(const SignificantRegion& a, const SignificantRegion& b) {
  if (b.ranges.empty() || a.significant != b.significant) return b.ranges.empty() || a.significant;
  return a.gain > b.gain;
}

RegionRange range(const Region& region, std::size_t first, std::size_t last) {
  RegionRange r;
  r.variable = region.variable;
  r.from = region.bins[first].from;
  r.to = region.bins[last].to;
  r.name = region.bins[first].name;
  r.lowest = first == 0;
  r.highest = last + 1 == region.bins.size();
  return r;
}

struct Found {
  SignificantRegion failing;
  std::vector<char> in;
};

Found best_of(const SortedErrors& sorted, const Region& region, const All& all) {
  Found best;
  const std::size_t bins = region.bins.size();
  const bool named = region.variable == "direction";
  for (std::size_t first = 0; first < bins; ++first) {
    const std::size_t end = named ? first + 1 : bins;
    for (std::size_t last = first; last < end; ++last) {
      if (last - first + 1 == bins) continue;
      std::vector<char> in(region.bin_of.size());
      for (std::size_t k = 0; k < in.size(); ++k) {
        in[k] = region.bin_of[k] >= static_cast<int>(first) &&
                region.bin_of[k] <= static_cast<int>(last);
      }
      SignificantRegion failing{{range(region, first, last)}, figures(sorted, in, all.length)};
      judge(failing, sorted, all);
      failing.figures.from = failing.ranges[0].from;
      failing.figures.to = failing.ranges[0].to;
      failing.figures.name = failing.ranges[0].name;
      if (better(failing, best.failing)) best = {failing, in};
    }
  }
  return best;
}

std::vector<Found> found_in(const SortedErrors& sorted, const std::vector<Region>& regions,
                            const All& all) {
  std::vector<Found> found;
  for (const Region& region : regions) {
    Found best = best_of(sorted, region, all);
    if (!best.failing.ranges.empty()) found.push_back(std::move(best));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return better(a.failing, b.failing); });
  return found;
}

}  // namespace

std::vector<SignificantRegion> significant_regions(const SortedErrors& sorted,
                                                   const std::vector<Region>& regions) {
  std::vector<SignificantRegion> failing;
  for (const Found& found : found_in(sorted, regions, all_of(sorted))) {
    failing.push_back(found.failing);
  }
  return failing;
}

SignificantRegion narrowed(const SortedErrors& sorted, const std::vector<Region>& regions,
                           const std::vector<SignificantRegion>& singles) {
  if (singles.empty()) return {};
  const All all = all_of(sorted);
  const std::vector<Found> found = found_in(sorted, regions, all);
  SignificantRegion best = found.front().failing;
  const double least = kNarrowing * best.gain;
  for (std::size_t other = 1; other < found.size(); ++other) {
    std::vector<char> both(found[other].in.size());
    for (std::size_t k = 0; k < both.size(); ++k) {
      both[k] = found.front().in[k] != 0 && found[other].in[k] != 0;
    }
    SignificantRegion joint{{found.front().failing.ranges[0], found[other].failing.ranges[0]},
                            figures(sorted, both, all.length)};
    judge(joint, sorted, all);
    if (joint.significant && joint.gain > std::max(least, best.gain)) best = joint;
  }
  return best;
}

}  // namespace estimator::greybox::validation
