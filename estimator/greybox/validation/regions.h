// Errors of a model grouped by the rod's motion: bins over position, velocity, speed, command,
// acceleration, direction and time, with the error in each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/greybox/kinematics.h"

namespace estimator::greybox::validation {

/// Errors and the variables they are grouped by; all series have the record's length, SI.
struct SortedErrors {
  const Dataset* record = nullptr;
  const Kinematics* kinematics = nullptr;
  const std::vector<double>* error_m = nullptr;
  const std::vector<double>* speed_error_mps = nullptr;  ///< measured less modelled speed
  const std::vector<double>* local_velocity_error_mps =
      nullptr;               ///< series by which regions are found
  std::vector<char> counts;  ///< 0: the sample is left out
  double noise_mps = 0.0;    ///< sensor noise of local_velocity_error
};

struct Bin {
  double from = 0.0;  ///< SI; NaN for direction
  double to = 0.0;
  std::string name;  ///< for direction: "extending"; else empty
  std::size_t count = 0;
  double time_share = 0.0;
  double error_share = 0.0;  ///< share of the squared position error
  double rms_m = 0.0;        ///< position error
  double mean_m = 0.0;
  double speed_error_mps = 0.0;  ///< mean; positive: the rod extends faster than the model
  double local_velocity_error_rms_mps = 0.0;
  double local_velocity_error_share = 0.0;  ///< share of the squared speed error
  /// Number of samples at least a correlation length apart.
  double effective_samples = 0.0;
};

struct Region {
  std::string variable;  ///< y, v, speed, u, acceleration, direction, time
  std::vector<Bin> bins;
  std::vector<int> bin_of;  ///< per sample; -1: left out
};

/// Correlation length of the squared velocity errors in samples: 1 + 2 sum rho(k)^2.
[[nodiscard]] double correlation_length(const SortedErrors& sorted);

/// Edges are round numbers; a bin of too few samples is merged with its neighbour.
[[nodiscard]] std::vector<Region> sort_by_region(const SortedErrors& sorted);

/// Figures of the samples with `in` not 0; the caller sets from, to and name.
[[nodiscard]] Bin figures(const SortedErrors& sorted, const std::vector<char>& in, double length);

}  // namespace estimator::greybox::validation
