// The model as given: unchanged, and with its parameters fitted.
#pragma once

#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Held-out error of the model file unchanged.
[[nodiscard]] double nominal_rms_m(const SearchContext& context);

/// The model as given with its parameters fitted. Where the file has effects and the fit is far
/// from the noise, also from the parameters of the likeliest innovations: the free run of a rod
/// that sticks has minima about many values of its friction, the innovations, which forget, have
/// few.
[[nodiscard]] ModelStage first_stage(const SearchContext& context);

}  // namespace estimator::greybox::selection
