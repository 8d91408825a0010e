// Credibility of a search's noise model: it explains what a simulation leaves, or stands for what
// the model lacks.
#pragma once

#include <optional>

#include "estimator/greybox/selection/disturbance_report.h"
#include "estimator/greybox/selection/innovation_search.h"

namespace estimator::greybox::selection {

/// RMS of the force that the command commands, about its mean; 0 where it commands none.
[[nodiscard]] double rms_of_drive_N(const SearchContext& search, const FitSummary& fitted);

/// Noise of the sensor: the data set's floor, or the noise model's where that is no more than a
/// bound.
[[nodiscard]] double sensor_noise_m(const SearchContext& search,
                                    const InnovationSearch& innovations, bool floor_assumed);

/// True where the rig amplifies a disturbance that is next to nothing until a simulation loses the
/// motion: its error is then no measure of a model.
[[nodiscard]] bool loses_motion(const SearchContext& search, const InnovationSearch& innovations,
                                const std::optional<Disturbance>& disturbance);

/// True where what sensor and disturbance would cause in a simulation, by the noise model, agrees
/// with its error `rms_m`: what explains the samples has to explain the simulation too.
[[nodiscard]] bool noise_is_credible(const SearchContext& search,
                                     const InnovationSearch& innovations, double sensor_m,
                                     const std::optional<Disturbance>& disturbance, double rms_m);

}  // namespace estimator::greybox::selection
