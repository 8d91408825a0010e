// Baseline of the rig without a fault, learned from windows of healthy motion: medians of each
// tracked parameter, of the window's error and of the chamber pressures' errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/greybox/tracking/process_noise.h"
#include "estimator/greybox/tracking/window_result.h"

namespace estimator::greybox::tracking {

/// Healthy values and errors of a rig.
struct Baseline {
  double rms_m = 0.0;     ///< error of a window; at least the noise floor
  Eigen::VectorXd theta;  ///< every parameter of the set, search units
  ChamberErrors chambers{};
  /// Present on a disturbed rig (disturbed_baseline.h): rms_m is then the standard deviation of the
  /// scaled innovations.
  std::optional<ProcessNoise> noise{};

  [[nodiscard]] ErrorScales errors() const { return {rms_m, chambers}; }
};

/// True when a window qualifies for the baseline: explained, every parameter known to a few per
/// cent.
[[nodiscard]] bool qualifies_for_baseline(const WindowResult& window, const ParameterSet& set);

/// Index of the first tracked parameter that no window determines well enough; none: the windows
/// suffice for learn_baseline().
[[nodiscard]] std::optional<std::size_t> undetermined_parameter(
    const std::vector<WindowResult>& windows, const ParameterSet& set);

/// True when the windows look like those of a disturbed rig: errors well above the noise floor, and
/// a tracked parameter that few of them determine.
[[nodiscard]] bool look_disturbed(const std::vector<WindowResult>& windows, const ParameterSet& set,
                                  double noise_floor_m);

/// Medians over the explained windows of a record without a fault; parameters that are not tracked
/// keep the model file's values. Requires that no parameter is undetermined.
[[nodiscard]] Baseline learn_baseline(const std::vector<WindowResult>& windows,
                                      const ParameterSet& set, double noise_floor_m);

}  // namespace estimator::greybox::tracking
