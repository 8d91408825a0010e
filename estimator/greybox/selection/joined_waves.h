// Two periodic effects along the stroke in place of one: a wave of few turns over the motion looks
// like another of many, and a second one makes up for the difference.
#pragma once

#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Leaves one of two periodic effects, at the wavelength of the other, where that explains as much.
void join_waves(const SearchContext& context, ModelStage& stage);

}  // namespace estimator::greybox::selection
