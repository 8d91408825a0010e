#include "estimator/fdi/learn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_data;

constexpr double kEulerGamma = 0.57721566490153286;
constexpr double kOneSided95 = 1.6449;
constexpr std::size_t kFewestBlocks = 10;
constexpr std::size_t kEnoughBlocks = 20;
constexpr double kWindowsPerBlock = 5.0;

/// Upper confidence limit of the level that block maxima exceed with probability `rate`.
double gumbel_level(std::vector<double> maxima, double rate) {
  std::sort(maxima.begin(), maxima.end());
  const auto n = static_cast<double>(maxima.size());
  double mean = 0.0;
  double weighted = 0.0;
  for (std::size_t i = 0; i < maxima.size(); ++i) {
    mean += maxima[i] / n;
    weighted += maxima[i] * static_cast<double>(i) / (n * (n - 1.0));
  }
  const double beta = std::max(0.0, 2.0 * weighted - mean) / std::log(2.0);
  const double mu = mean - kEulerGamma * beta;
  const double y = -std::log(-std::log1p(-rate));
  const double error = beta * std::sqrt((1.113 + 0.457 * y + 0.805 * y * y) / n);
  return mu + beta * y + kOneSided95 * error;
}

double signed_square(double x) { return x * std::abs(x); }
double signed_root(double x) { return std::copysign(std::sqrt(std::abs(x)), x); }

/// Distance of the limit from `centre`, upward (side 1) or downward (side -1).
double margin(const std::vector<double>& extremes, double centre, double side, double rate) {
  std::vector<double> squares;
  squares.reserve(extremes.size());
  for (const double extreme : extremes) squares.push_back(signed_square(side * (extreme - centre)));
  return signed_root(gumbel_level(std::move(squares), rate));
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
  const auto length =
      static_cast<std::size_t>(std::max(1.0, std::round(out.block_s / config.interval_s)));
  const BlockExtremes extremes = find_extremes(values, length);
  out.blocks = extremes.greatest.size();
  if (out.blocks < kFewestBlocks) {
    std::ostringstream what;
    what << "the healthy record is too short: " << out.blocks << " blocks of " << out.block_s
         << " s with trustworthy estimates";
    throw bad_data("learning bands", what.str(), std::to_string(kFewestBlocks) + " or more");
  }
  out.centre = extremes.mean;
  const double above = margin(extremes.greatest, extremes.mean, 1.0, rate);
  const double below = margin(extremes.least, extremes.mean, -1.0, rate);
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
