#include "estimator/residual/comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "estimator/residual/special.h"

namespace estimator::residual {

Comparison compare_residuals(std::span<const double> first, std::span<const double> second,
                             int block) {
  assert(first.size() == second.size() && block > 0);
  Comparison out;
  std::vector<double> differences;
  double first_sum = 0.0;
  double second_sum = 0.0;
  std::size_t samples = 0;
  const auto length = static_cast<std::size_t>(block);
  for (std::size_t begin = 0; begin < first.size(); begin += length) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t t = begin; t < std::min(begin + length, first.size()); ++t) {
      if (std::isnan(first[t]) || std::isnan(second[t])) continue;
      first_sum += first[t] * first[t];
      second_sum += second[t] * second[t];
      sum += first[t] * first[t] - second[t] * second[t];
      ++count;
    }
    samples += count;
    if (2 * count >= length) differences.push_back(sum / static_cast<double>(count));
  }
  const auto n = static_cast<double>(differences.size());
  out.blocks = static_cast<int>(differences.size());
  out.first_rms = std::sqrt(first_sum / static_cast<double>(samples));
  out.second_rms = std::sqrt(second_sum / static_cast<double>(samples));
  if (out.blocks < 3) {
    out.p = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  double mean = 0.0;
  for (const double d : differences) mean += d / n;
  double variance = 0.0;
  for (const double d : differences) variance += (d - mean) * (d - mean) / (n - 1.0);
  if (!(variance > 0.0)) return out;
  out.z = mean / std::sqrt(variance / n);
  out.p = student_two_sided(out.z, n - 1.0);
  return out;
}

}  // namespace estimator::residual
