// The readings of one channel at the samples of an even grid.
#pragma once

#include <vector>

namespace config::record {

/// Readings of one channel; the times increase.
struct Series {
  std::vector<double> t_s;
  std::vector<double> values;
};

struct EvenGrid {
  const std::vector<double>& t_s;
  double period_s = 0.0;
};

/// The newest reading at each sample. Samples between readings too far apart are marked in `hole`.
[[nodiscard]] std::vector<double> held(const Series& series, const EvenGrid& grid,
                                       std::vector<char>& hole);

/// Between readings linearly, NaN where there is none; where they are too far apart, samples of a
/// `main` channel are marked in `hole`, and others NaN.
[[nodiscard]] std::vector<double> interpolated(const Series& series, bool main,
                                               const EvenGrid& grid, std::vector<char>& hole);

}  // namespace config::record
