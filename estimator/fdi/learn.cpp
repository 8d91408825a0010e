#include "estimator/fdi/learn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_data;

constexpr double kEulerGamma = 0.57721566490153286;
constexpr double kQuantile95 = 1.6449;
constexpr std::size_t kFewestBlocks = 10;
constexpr std::size_t kEnoughBlocks = 20;
constexpr double kWindowsPerBlock = 5.0;
constexpr std::size_t kFewBlocks = 50;
constexpr std::size_t kFewInABlock = 5;

struct Gumbel {
  double mu, beta;
};

Gumbel fit_gumbel(std::vector<double>& maxima) {
  std::sort(maxima.begin(), maxima.end());
  const auto n = static_cast<double>(maxima.size());
  double mean = 0.0;
  double weighted = 0.0;
  for (std::size_t i = 0; i < maxima.size(); ++i) {
    mean += maxima[i] / n;
    weighted += maxima[i] * static_cast<double>(i) / (n * (n - 1.0));
  }
  const double beta = std::max(0.0, 2.0 * weighted - mean) / std::log(2.0);
  return {mean - kEulerGamma * beta, beta};
}

/// The level that is exceeded with probability `rate`, in betas above mu.
double reduced_variate(double rate) { return -std::log(-std::log1p(-rate)); }

double variance_factor(double y) { return 1.113 + 0.457 * y + 0.805 * y * y; }

/// The upper confidence limit of the level y of n maxima, in estimated betas above the estimated
/// mu. (y - mu)/beta of a fit to a standard Gumbel sample does not depend on the true mu and beta:
/// its 95 % quantile, by simulation where n is small.
double limit_factor(std::size_t n, double y) {
  constexpr std::size_t kMany = 200;
  constexpr std::size_t kDraws = 4000;
  if (n > kMany) return y + kQuantile95 * std::sqrt(variance_factor(y) / static_cast<double>(n));
  std::mt19937_64 random(n);
  std::vector<double> sample(n);
  std::vector<double> pivots(kDraws);
  for (double& pivot : pivots) {
    for (double& value : sample) {
      const double uniform = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
      value = -std::log(-std::log(uniform));
    }
    const Gumbel fit = fit_gumbel(sample);
    pivot = (y - fit.mu) / fit.beta;
  }
  const auto at = pivots.begin() + static_cast<std::ptrdiff_t>(0.95 * kDraws);
  std::nth_element(pivots.begin(), at, pivots.end());
  return *at;
}

/// Blocks from which on the margin is widened by less than a tenth.
double enough_blocks(double y) {
  constexpr double kSquare = 1.1 * 1.1 - 1.0;
  const double ratio = kQuantile95 / (kSquare * y);
  return std::ceil(ratio * ratio * variance_factor(y));
}

/// The z that a standard normal value exceeds with that probability, below 0.5.
double normal_quantile(double probability) {
  double low = 0.0;
  double high = 40.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
  }
  return low;
}

/// Upper 95 % confidence limit of that quantile from n normal values, in standard deviations from
/// their mean (one-sided tolerance factor; Natrella, Experimental Statistics, 1963).
double tolerance_factor(double n, double quantile) {
  const double a = 1.0 - kQuantile95 * kQuantile95 / (2.0 * (n - 1.0));
  const double b = quantile * quantile - kQuantile95 * kQuantile95 / n;
  return (quantile + std::sqrt(std::max(0.0, quantile * quantile - a * b))) / a;
}

/// Distance of the limits of few estimates, or of few in a block, whose maxima are far from Gumbel:
/// taken for normal, as many as there are windows.
double normal_margin(std::span<const double> values, const LearnConfig& config, double mean) {
  double squares = 0.0;
  double count = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    squares += (value - mean) * (value - mean);
    count += 1.0;
  }
  const double apart_s = std::max(config.interval_s, config.window_s);
  const double n = std::max(5.0, count * config.interval_s / apart_s);
  const double quantile = normal_quantile(0.5 * std::min(1.0, apart_s / config.false_alarm_time_s));
  return tolerance_factor(n, quantile) * std::sqrt(squares / std::max(1.0, count - 1.0));
}

double signed_square(double x) { return x * std::abs(x); }
double signed_root(double x) { return std::copysign(std::sqrt(std::abs(x)), x); }

/// Distance of the limit from `centre`, upward (side 1) or downward (side -1).
double margin(const std::vector<double>& extremes, double centre, double side, double factor) {
  std::vector<double> squares;
  squares.reserve(extremes.size());
  for (const double extreme : extremes) squares.push_back(signed_square(side * (extreme - centre)));
  const Gumbel fit = fit_gumbel(squares);
  return signed_root(fit.mu + factor * fit.beta);
}

/// The extremes of each block of `length` values that has a trustworthy one.
struct BlockExtremes {
  std::vector<double> greatest;
  std::vector<double> least;
  double mean = 0.0;  ///< mean of all values
};

BlockExtremes find_extremes(std::span<const double> values, std::size_t length) {
  BlockExtremes out;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin + length <= values.size(); begin += length) {
    double greatest = -std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (const double value : values.subspan(begin, length)) {
      if (std::isnan(value)) continue;
      greatest = std::max(greatest, value);
      least = std::min(least, value);
      sum += value;
      ++count;
    }
    if (greatest < least) continue;
    out.greatest.push_back(greatest);
    out.least.push_back(least);
  }
  out.mean = sum / static_cast<double>(count);
  return out;
}

/// Whole periods (or windows) that span several windows, shorter when that leaves few blocks.
double block_length_s(const LearnConfig& config, double duration_s) {
  const double unit_s =
      std::max(config.period_s > 0.0 ? config.period_s : config.window_s, config.interval_s);
  double units = std::max(1.0, std::ceil(kWindowsPerBlock * config.window_s / unit_s));
  while (units > 1.0 && duration_s / (units * unit_s) < static_cast<double>(kEnoughBlocks)) {
    units -= 1.0;
  }
  return units * unit_s;
}

}  // namespace

LearnedLimits learn_limits(std::span<const double> values, const LearnConfig& config) {
  LearnedLimits out;
  const double duration_s = static_cast<double>(values.size()) * config.interval_s;
  out.block_s = block_length_s(config, duration_s);
  const double rate = out.block_s / (2.0 * config.false_alarm_time_s);
  if (!(rate < 0.5)) {
    throw bad_data("learning bands", "the false-alarm time is shorter than a block of estimates");
  }
  const double y = reduced_variate(rate);
  out.enough_s = std::max(enough_blocks(y), static_cast<double>(kFewBlocks)) * out.block_s;
  const auto length =
      static_cast<std::size_t>(std::max(1.0, std::round(out.block_s / config.interval_s)));
  const BlockExtremes extremes = find_extremes(values, length);
  out.blocks = extremes.greatest.size();
  if (out.blocks < kFewestBlocks) {
    std::ostringstream what;
    what << "the healthy record is too short: " << out.blocks << " blocks of " << out.block_s
         << " s with trustworthy estimates";
    std::ostringstream allowed;
    allowed << kFewestBlocks << " or more, " << static_cast<double>(kFewestBlocks) * out.block_s
            << " s of healthy motion beside warm-up; " << out.enough_s
            << " s for bands that need no widening";
    throw bad_data("learning bands", what.str(), allowed.str());
  }
  out.centre = extremes.mean;
  const double factor = limit_factor(out.blocks, y);
  double above = margin(extremes.greatest, extremes.mean, 1.0, factor);
  double below = margin(extremes.least, extremes.mean, -1.0, factor);
  if (out.blocks < kFewBlocks || length < kFewInABlock) {
    const double normal = normal_margin(values, config, extremes.mean);
    above = std::max(above, normal);
    below = std::max(below, normal);
  }
  const double exact = margin(extremes.greatest, extremes.mean, 1.0, y);
  out.widening_ratio = exact > 0.0 ? above / exact : 1.0;
  const auto least = std::min_element(extremes.least.begin(), extremes.least.end());
  const auto greatest = std::max_element(extremes.greatest.begin(), extremes.greatest.end());
  out.high = std::max(out.centre + above, *greatest + config.least_margin);
  out.low = std::min(out.centre - below, *least - config.least_margin);
  return out;
}

double find_period_s(std::span<const double> signal, double sample_time_s) {
  constexpr std::size_t kMost = 4000;  // samples looked at
  constexpr double kPeak = 0.8;        // correlation that counts as repeating
  constexpr double kStep_s = 0.02;
  const auto step = static_cast<std::size_t>(std::max(1.0, std::floor(kStep_s / sample_time_s)));
  std::vector<double> x;
  double mean = 0.0;
  for (std::size_t i = 0; i < signal.size() && x.size() < kMost; i += step) x.push_back(signal[i]);
  for (const double value : x) mean += value / static_cast<double>(x.size());
  for (double& value : x) value -= mean;
  const auto correlation = [&x](std::size_t lag) {
    double xy = 0.0, xx = 0.0, yy = 0.0;
    for (std::size_t i = lag; i < x.size(); ++i) {
      xy += x[i] * x[i - lag];
      xx += x[i] * x[i];
      yy += x[i - lag] * x[i - lag];
    }
    return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
  };
  bool been_low = false;
  std::size_t best = 0;
  double highest = kPeak;
  for (std::size_t lag = 1; lag < x.size() / 2; ++lag) {
    const double r = correlation(lag);
    been_low = been_low || r < 0.5;
    if (!been_low) continue;
    if (r > highest) {
      highest = r;
      best = lag;
    } else if (best != 0 && r < 0.5) {
      break;
    }
  }
  return static_cast<double>(best * step) * sample_time_s;
}

}  // namespace estimator::fdi
