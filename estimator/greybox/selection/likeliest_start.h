// Where the parameters of a model start when predictors of their own judge them: with the gains of
// another start, or of a model without a resonance, a fit sees only what those leave.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/disturbance/noise_model.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

struct LikeliestStart {
  ParameterSubset start;
  /// Priors included; infinite where no start is likely enough, and for an only start without a
  /// second mass, which is not evaluated.
  double minus_two_log = std::numeric_limits<double>::infinity();
  disturbance::NoiseModel noise;  ///< found with it; as given for a start that is not evaluated
};

/// The likeliest of `starts` (not empty), each linearised and with a noise model searched from
/// `noise`, and where a second mass swings with the random force on either mass; the first where
/// none is. Of more than three candidates those are followed that a first look at their noise
/// models finds likelier than -2 log L = `hopeless_minus_two_log`.
[[nodiscard]] LikeliestStart likeliest_start(
    const SearchContext& plain, std::vector<ParameterSubset> starts,
    const disturbance::NoiseModel& noise, unsigned threads,
    double hopeless_minus_two_log = std::numeric_limits<double>::infinity());

/// The model with these effects at a start, not fitted.
[[nodiscard]] ModelStage model_at(std::vector<std::string> added, ParameterSubset start);

/// Models with the resonance of `model`: shares of the mass and a damping that structures have, the
/// sensor, where it is free, on the second mass, the plant as the model and as the file have it;
/// none for a model without one.
[[nodiscard]] std::vector<ParameterSubset> mass_share_starts(const SearchContext& context,
                                                             const ModelStage& model);

}  // namespace estimator::greybox::selection
