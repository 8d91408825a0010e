#include "estimator/residual/diebold_mariano.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "config/signals/nan.h"
#include "estimator/residual/distributions.h"

namespace estimator::residual {

using config::signals::kNaN;

DieboldMarianoResult diebold_mariano_test(std::span<const double> first,
                                          std::span<const double> second, int block) {
  assert(first.size() == second.size() && block > 0);
  DieboldMarianoResult out;
  std::vector<double> differences;
  double first_sum = 0.0;
  double second_sum = 0.0;
  std::size_t samples = 0;
  const auto length = static_cast<std::size_t>(block);
  for (std::size_t begin = 0; begin < first.size(); begin += length) {
    double first_energy = 0.0;
    double second_energy = 0.0;
    std::size_t count = 0;
    for (std::size_t t = begin; t < std::min(begin + length, first.size()); ++t) {
      if (std::isnan(first[t]) || std::isnan(second[t])) continue;
      first_energy += first[t] * first[t];
      second_energy += second[t] * second[t];
      ++count;
    }
    samples += count;
    first_sum += first_energy;
    second_sum += second_energy;
    if (2 * count < length) continue;
    if (!(first_energy > 0.0 && second_energy > 0.0)) continue;
    const double d = std::log(first_energy / second_energy) / static_cast<double>(count);
    if (!std::isnan(d)) differences.push_back(d);
  }
  const auto n = static_cast<double>(differences.size());
  out.blocks = static_cast<int>(differences.size());
  out.first_rms = std::sqrt(first_sum / static_cast<double>(samples));
  out.second_rms = std::sqrt(second_sum / static_cast<double>(samples));
  if (out.blocks < 3) {
    out.p = kNaN;
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
