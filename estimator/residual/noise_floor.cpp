#include "estimator/residual/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "config/signals/nan.h"
#include "estimator/residual/distributions.h"

namespace estimator::residual {
namespace {

using config::signals::kNaN;

constexpr int kOrder = 8;
constexpr std::size_t kWindow = 32;  // differences in a window
constexpr double kQuantile = 0.2;
constexpr double kOutlier = 0.01;      // probability that noise alone looks like motion
constexpr double kDust = 1e-11;        // ratio to the largest reading: rounding of the arithmetic
constexpr double kOffGrid = 0.25;      // share of a step: largest shift of a reading by decimals
constexpr double kMostSteps = 1000.0;  // larger differences do not constrain the grid
constexpr double kOnGridShare = 0.98;
constexpr double kDither =
    0.35;  // noise, in steps, that makes rounding at rest like that in motion
constexpr std::size_t kFewestWindows = 4;
constexpr double kSlowest_s = 0.05;
constexpr double kLeastShare = 0.01;  // share of noise in what the differences leave of a slow log

double binomial(int n, int k) {
  double out = 1.0;
  for (int i = 1; i <= k; ++i) out = out * (n - k + i) / i;
  return out;
}

/// Degrees of freedom of the mean square of `count` neighbouring differences of order kOrder.
double equivalent_dof(std::size_t count) {
  double sum = 1.0;
  for (int lag = 1; lag <= kOrder; ++lag) {
    const double rho = binomial(2 * kOrder, kOrder - lag) / binomial(2 * kOrder, kOrder);
    sum += 2.0 * rho * rho * (1.0 - static_cast<double>(lag) / static_cast<double>(count));
  }
  return static_cast<double>(count) / sum;
}

/// Refines a trial step on increasing differences; 0 when they do not lie on its grid.
double refined(double step, const std::vector<double>& sorted) {
  double reach = 3.0;
  while (reach <= kMostSteps) {
    double above = 0.0;
    double below = 0.0;
    for (const double d : sorted) {
      if (d < 0.5 * step) continue;
      if (d > (reach + 0.5) * step) break;
      const double n = std::round(d / step);
      above += n * d;
      below += n * n;
    }
    if (below > 0.0) step = above / below;
    reach *= 3.0;
  }
  std::size_t on = 0;
  std::size_t all = 0;
  for (const double d : sorted) {
    if (d > kMostSteps * step) break;
    ++all;
    on += std::abs(d - step * std::round(d / step)) <= kOffGrid * step;
  }
  return all > 0 && static_cast<double>(on) >= kOnGridShare * static_cast<double>(all) ? step : 0.0;
}

struct Energies {
  std::vector<double> moving;
  std::vector<double> all;
};

Energies windows_of(std::span<const double> y_m, double step_m) {
  std::vector<double> d(y_m.begin(), y_m.end());
  for (int k = 0; k < kOrder; ++k) {
    for (std::size_t t = 0; t + 1 < d.size(); ++t) d[t] = d[t + 1] - d[t];
    d.pop_back();
  }
  Energies out;
  for (std::size_t begin = 0; begin + kWindow <= d.size(); begin += kWindow / 2) {
    double sum = 0.0;
    for (std::size_t t = begin; t < begin + kWindow; ++t) sum += d[t] * d[t];
    if (std::isnan(sum)) continue;
    sum /= static_cast<double>(kWindow) * binomial(2 * kOrder, kOrder);
    out.all.push_back(sum);
    // Travel between medians of the first and last quarter, insensitive to noise.
    std::vector<double> head(y_m.begin() + static_cast<std::ptrdiff_t>(begin),
                             y_m.begin() + static_cast<std::ptrdiff_t>(begin + kWindow / 4));
    std::vector<double> tail(y_m.begin() + static_cast<std::ptrdiff_t>(begin + kWindow * 3 / 4),
                             y_m.begin() + static_cast<std::ptrdiff_t>(begin + kWindow));
    std::nth_element(head.begin(), head.begin() + 4, head.end());
    std::nth_element(tail.begin(), tail.begin() + 4, tail.end());
    if (std::abs(tail[4] - head[4]) > 2.0 * step_m) out.moving.push_back(sum);
  }
  return out;
}

/// Leaves out windows whose readings repeat but for the arithmetic's rounding, where enough others
/// are left: an encoder whose step interpolation hides stands still there, and shows no noise.
void leave_out_repeated(std::span<const double> y_m, Energies& energies) {
  double largest_m = 0.0;
  for (const double y : y_m) largest_m = std::max(largest_m, std::isnan(y) ? 0.0 : std::abs(y));
  const auto repeats = [&](double energy) { return std::sqrt(energy) <= kDust * largest_m; };
  const auto left = static_cast<std::size_t>(std::count_if(
      energies.all.begin(), energies.all.end(), [&](double energy) { return !repeats(energy); }));
  if (left < kFewestWindows) return;
  std::erase_if(energies.all, repeats);
  std::erase_if(energies.moving, repeats);
}

/// Mean square of pure noise from windows, some of which contain motion.
double level_of(std::vector<double> e) {
  const auto k = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(e.size()));
  std::nth_element(e.begin(), e.begin() + k, e.end());
  const double dof = equivalent_dof(kWindow);
  const double level =
      e[static_cast<std::size_t>(k)] * dof / chi_square_quantile_upper(1.0 - kQuantile, dof);
  // The mean of all windows that could be noise alone is the sharper figure.
  const double limit = level * chi_square_quantile_upper(kOutlier, dof) / dof;
  double sum = 0.0;
  double count = 0.0;
  for (const double energy : e) {
    if (energy > limit) continue;
    sum += energy;
    count += 1.0;
  }
  return sum / count;
}

}  // namespace

double encoder_step_m(std::span<const double> y_m) {
  std::vector<double> sorted;
  double largest = 0.0;
  for (const double y : y_m) {
    if (std::isnan(y)) continue;
    sorted.push_back(y);
    largest = std::max(largest, std::abs(y));
  }
  std::sort(sorted.begin(), sorted.end());
  // Gaps between readings in order of size, however fast the rod went, and moves in time.
  std::vector<double> gaps;
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const double gap = sorted[k] - sorted[k - 1];
    if (gap > kDust * largest) gaps.push_back(gap);
  }
  if (gaps.empty()) return 0.0;
  std::sort(gaps.begin(), gaps.end());
  std::vector<double> d = gaps;
  for (std::size_t t = 1; t < y_m.size(); ++t) {
    const double difference = std::abs(y_m[t] - y_m[t - 1]);
    if (difference > kDust * largest) d.push_back(difference);  // false for NaN
  }
  std::sort(d.begin(), d.end());
  // The smallest gap is a step, unless it is a rare accident.
  for (const double quantile : {0.1, 0.03, 0.01, 0.0}) {
    const double trial =
        gaps[static_cast<std::size_t>(quantile * static_cast<double>(gaps.size() - 1))];
    if (const double step = refined(trial, d); step > 0.0) return step;
  }
  return 0.0;
}

NoiseFloor noise_floor(std::span<const double> y_m, double sample_time_s) {
  NoiseFloor out;
  out.sd_m = kNaN;
  out.encoder_step_m = encoder_step_m(y_m);
  out.least_m = out.encoder_step_m / std::sqrt(12.0);
  if (y_m.size() < kWindow + kOrder) return out;
  Energies energies = windows_of(y_m, out.encoder_step_m);
  if (energies.all.empty()) return out;
  if (out.encoder_step_m == 0.0) leave_out_repeated(y_m, energies);
  if (!(sample_time_s <= kSlowest_s)) {
    if (out.least_m == 0.0) out.least_m = kLeastShare * std::sqrt(level_of(energies.all));
    return out;
  }
  out.at_rest = energies.moving.size() < std::max(kFewestWindows, energies.all.size() / 20);
  double square = level_of(energies.all);
  const double rounding = out.encoder_step_m * out.encoder_step_m / 12.0;
  const double dithers = std::pow(kDither * out.encoder_step_m, 2);
  if (!out.at_rest && square < rounding + dithers) square = level_of(energies.moving);
  out.sd_m = std::sqrt(std::max(square, rounding));
  out.least_m = out.sd_m;
  return out;
}

}  // namespace estimator::residual
