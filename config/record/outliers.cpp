#include "config/record/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace config::record {
namespace {

constexpr std::size_t kWindow = 7;  ///< a sample and three on each side of it
/// Deviations from the running median, in their usual size, and in the span of the values: a jump
/// of a command that stays is no outlier, and neither is noise.
constexpr double kDeviations = 50.0;
constexpr double kSpans = 0.1;

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::vector<std::size_t> find_outliers(const std::vector<double>& values,
                                       const std::vector<std::size_t>& gaps) {
  std::vector<std::size_t> outliers;
  const std::size_t n = values.size();
  constexpr std::size_t kFewest = 50;
  if (n < kFewest) return outliers;
  std::vector<double> deviation(n, 0.0);
  for (std::size_t i = kWindow / 2; i + kWindow / 2 < n; ++i) {
    std::array<double, kWindow> window{};
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i - kWindow / 2), kWindow,
                window.begin());
    std::nth_element(window.begin(), window.begin() + kWindow / 2, window.end());
    deviation[i] = std::abs(values[i] - window[kWindow / 2]);
  }
  const double usual = quantile(deviation, 0.9);
  const double span = quantile(values, 0.99) - quantile(values, 0.01);
  const double least = std::max(kDeviations * usual, kSpans * span);
  if (!(least > 0.0)) return outliers;
  const auto near_gap = [&gaps](std::size_t i) {
    const auto after = std::upper_bound(gaps.begin(), gaps.end(), i + kWindow / 2);
    return after != gaps.begin() && *(after - 1) + kWindow / 2 >= i;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (deviation[i] > least && !near_gap(i)) outliers.push_back(i);
  }
  return outliers;
}

}  // namespace config::record
