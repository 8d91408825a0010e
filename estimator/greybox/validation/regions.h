// A model's error sorted by what the rod was doing: bins over position, velocity, speed, command,
// acceleration, direction and time, and what the error is in each.
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
  double from = 0.0;  ///< SI; of direction: NaN
  double to = 0.0;
  std::string name;  ///< for direction: "extending"; else empty
  std::size_t count = 0;
  double time_share = 0.0;
  double error_share = 0.0;  ///< share of the squared position error
  double rms_m = 0.0;        ///< position error
  double mean_m = 0.0;
  double speed_error_mps = 0.0;  ///< mean; positive: the rod moves out more than the model
  double local_velocity_error_rms_mps = 0.0;
  double local_velocity_error_share = 0.0;  ///< share of the squared speed error
  /// How many samples at least a correlation length apart: what the RMS is worth.
  double effective_samples = 0.0;
};

struct Region {
  std::string variable;  ///< y, v, speed, u, acceleration, direction, time
  std::vector<Bin> bins;
  std::vector<int> bin_of;  ///< per sample; -1: left out
};

/// Over how many samples arising errors hang together: 1 + 2 sum rho(k)^2, that of their squares.
[[nodiscard]] double correlation_length(const SortedErrors& sorted);

/// Edges are round numbers; a bin of too few samples is joined with its neighbour.
[[nodiscard]] std::vector<Region> sort_by_region(const SortedErrors& sorted);

/// Figures of the samples where `in` is not 0; from, to and name are left to the caller.
[[nodiscard]] Bin figures(const SortedErrors& sorted, const std::vector<char>& in, double length);

}  // namespace estimator::greybox::validation
