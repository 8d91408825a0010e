// Series of independent normal numbers.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace spectra_test {

/// The same for the same seed.
inline std::vector<double> white_noise(std::size_t n, double sd, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sd);
  std::vector<double> values(n);
  for (double& value : values) value = normal(random);
  return values;
}

}  // namespace spectra_test
