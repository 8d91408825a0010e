// Baseline of a rig whose process is disturbed: healthy values, noise model and spectral lines from
// one stretch of healthy motion, all of it fitted together.
//
// A window of a few seconds determines such a rig's parameters badly: the whole stretch is fitted
// by its innovations, with noise model and parameters in turn. Lines are added one by one while the
// likelihood rises.
#pragma once

#include <optional>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/tracking/baseline.h"

namespace estimator::greybox::tracking {

/// Shortest healthy motion from which a disturbance is learned.
inline constexpr double kLeastDisturbed_s = 8.0;

/// None: nothing beyond the sensor's noise disturbs the process, or `healthy` is too short. Takes
/// seconds for a minute of samples.
[[nodiscard]] std::optional<Baseline> learn_disturbed_baseline(const plant_sim::ModelFile& model,
                                                               const ParameterSet& set,
                                                               const Dataset& healthy,
                                                               unsigned threads);

}  // namespace estimator::greybox::tracking
