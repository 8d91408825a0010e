#include "estimator/greybox/validation/regions.h"

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"

namespace estimator::greybox::validation {
namespace {

using config::signals::kNaN;
constexpr double kBins = 9.0;
constexpr std::size_t kFewest = 40;
constexpr double kSmallestShare = 0.01;
/// Longest correlation that is searched.
constexpr double kLongest_s = 0.5;
/// Ratio to the greatest speed below which speeds share one bin.
constexpr double kSlowest = 0.004;

/// The next of 1, 2, 5, 10 ... at or above.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (value <= factor * decade * (1.0 + 1e-9)) return factor * decade;
  }
  return 10.0 * decade;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::vector<double> counted(const std::vector<double>& values, const std::vector<char>& counts) {
  std::vector<double> kept;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (counts[k] != 0) kept.push_back(values[k]);
  }
  return kept;
}

/// Inner edges at multiples of a round width.
std::vector<double> even_edges(const std::vector<double>& kept) {
  const double low = quantile(kept, 0.005);
  const double high = quantile(kept, 0.995);
  if (!(high > low)) return {};
  const double width = round_up((high - low) / kBins);
  std::vector<double> edges;
  for (double i = std::floor(low / width) + 1.0; i * width < high; i += 1.0) {
    edges.push_back(i * width);
  }
  return edges;
}

/// Inner edges 1, 2, 5, 10 ..., finer near standstill, where most errors arise.
std::vector<double> graded_edges(const std::vector<double>& kept) {
  const double high = quantile(kept, 0.995);
  if (!(high > 0.0)) return {};
  std::vector<double> edges;
  for (double edge = round_up(high * kSlowest); edge < high; edge = round_up(edge * 1.5)) {
    edges.push_back(edge);
  }
  return edges;
}

/// Removes edges between which there are too few samples.
std::vector<double> fewer(const std::vector<double>& edges, std::vector<double> kept) {
  std::sort(kept.begin(), kept.end());
  const auto fewest = std::max(
      kFewest, static_cast<std::size_t>(kSmallestShare * static_cast<double>(kept.size())));
  const auto below = [&](double edge) {
    return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), edge) -
                                    kept.begin());
  };
  std::vector<double> left;
  std::size_t last = 0;
  for (const double edge : edges) {
    const std::size_t here = below(edge);
    if (here - last < fewest) continue;
    left.push_back(edge);
    last = here;
  }
  while (!left.empty() && kept.size() - below(left.back()) < fewest) left.pop_back();
  return left;
}

Region by_number(const SortedErrors& sorted, const char* variable,
                 const std::vector<double>& values, bool graded, double correlation) {
  const std::vector<double> kept = counted(values, sorted.counts);
  const std::vector<double> edges = fewer(graded ? graded_edges(kept) : even_edges(kept), kept);
  Region region;
  region.variable = variable;
  region.bin_of.assign(values.size(), -1);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (sorted.counts[k] == 0) continue;
    region.bin_of[k] =
        static_cast<int>(std::upper_bound(edges.begin(), edges.end(), values[k]) - edges.begin());
  }
  const auto [least, most] = std::minmax_element(kept.begin(), kept.end());
  for (std::size_t b = 0; b <= edges.size(); ++b) {
    std::vector<char> in(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) in[k] = region.bin_of[k] == static_cast<int>(b);
    Bin bin = figures(sorted, in, correlation);
    bin.from = b > 0 ? edges[b - 1] : (graded ? 0.0 : *least);
    bin.to = b < edges.size() ? edges[b] : *most;
    region.bins.push_back(bin);
  }
  return region;
}

Region by_direction(const SortedErrors& sorted, double correlation) {
  Region region;
  region.variable = "direction";
  const std::vector<Direction>& direction = sorted.kinematics->direction;
  region.bin_of.assign(direction.size(), -1);
  for (const Direction which :
       {Direction::extending, Direction::retracting, Direction::resting, Direction::reversing}) {
    std::vector<char> in(direction.size());
    for (std::size_t k = 0; k < in.size(); ++k) {
      in[k] = sorted.counts[k] != 0 && direction[k] == which;
      if (in[k] != 0) region.bin_of[k] = static_cast<int>(region.bins.size());
    }
    Bin bin = figures(sorted, in, correlation);
    if (bin.count == 0) continue;
    bin.from = bin.to = kNaN;
    bin.name = to_string(which);
    region.bins.push_back(bin);
  }
  return region;
}

}  // namespace

double correlation_length(const SortedErrors& sorted) {
  const std::vector<double>& e = *sorted.local_velocity_error_mps;
  const auto longest =
      static_cast<std::size_t>(std::ceil(kLongest_s / sorted.record->sample_time_s));
  const std::size_t stride = std::max<std::size_t>(1, longest / 400);
  double at_zero = 0.0;
  for (std::size_t k = 0; k < e.size(); ++k) at_zero += sorted.counts[k] != 0 ? e[k] * e[k] : 0.0;
  if (!(at_zero > 0.0)) return 1.0;
  double length = 1.0;
  for (std::size_t lag = stride; lag <= longest && lag < e.size(); lag += stride) {
    double sum = 0.0;
    for (std::size_t k = lag; k < e.size(); ++k) {
      if (sorted.counts[k] != 0 && sorted.counts[k - lag] != 0) sum += e[k] * e[k - lag];
    }
    const double rho = sum / at_zero;
    length += 2.0 * rho * rho * static_cast<double>(stride);
  }
  return std::min(length, static_cast<double>(longest));
}

Bin figures(const SortedErrors& sorted, const std::vector<char>& in, double length) {
  Bin bin;
  double all_squares = 0.0;
  double squares = 0.0;
  double all_arising = 0.0;
  double arising = 0.0;
  std::size_t all = 0;
  double next = 0.0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    if (sorted.counts[k] == 0) continue;
    const double e = (*sorted.error_m)[k];
    const double a = (*sorted.local_velocity_error_mps)[k];
    all_squares += e * e;
    all_arising += a * a;
    ++all;
    if (in[k] == 0) continue;
    squares += e * e;
    arising += a * a;
    bin.mean_m += e;
    bin.speed_error_mps += (*sorted.speed_error_mps)[k];
    ++bin.count;
    if (static_cast<double>(k) >= next) {
      bin.effective_samples += 1.0;
      next = static_cast<double>(k) + length;
    }
  }
  if (bin.count == 0) return bin;
  const auto n = static_cast<double>(bin.count);
  bin.time_share = n / static_cast<double>(all);
  bin.error_share = all_squares > 0.0 ? squares / all_squares : 0.0;
  bin.rms_m = std::sqrt(squares / n);
  bin.local_velocity_error_share = all_arising > 0.0 ? arising / all_arising : 0.0;
  bin.local_velocity_error_rms_mps = std::sqrt(arising / n);
  bin.mean_m /= n;
  bin.speed_error_mps /= n;
  return bin;
}

std::vector<Region> sort_by_region(const SortedErrors& sorted) {
  const Kinematics& kinematics = *sorted.kinematics;
  const double length = correlation_length(sorted);
  std::vector<double> speed_mps(kinematics.speed_mps.size());
  std::transform(kinematics.speed_mps.begin(), kinematics.speed_mps.end(), speed_mps.begin(),
                 [](double v) { return std::abs(v); });
  std::vector<Region> regions;
  regions.push_back(by_number(sorted, "y", sorted.record->y_m, false, length));
  regions.push_back(by_number(sorted, "v", kinematics.speed_mps, false, length));
  regions.push_back(by_number(sorted, "speed", speed_mps, true, length));
  regions.push_back(by_number(sorted, "u", sorted.record->u_V, false, length));
  regions.push_back(by_number(sorted, "acceleration", kinematics.acceleration_mps2, false, length));
  regions.push_back(by_direction(sorted, length));
  regions.push_back(by_number(sorted, "time", sorted.record->t_s, false, length));
  return regions;
}

}  // namespace estimator::greybox::validation
