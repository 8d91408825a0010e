// File values that the record strains: plant parameters that a search leaves at the end of the
// range that their priors allow.
//
// Such a parameter cannot tell by how much the file is wrong, and an effect that acts as it does
// stands in for the rest. Wider ranges leave that to the prior's own weight.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Doubles the range of plant parameters at the end that `stage` has reached, the prior unchanged;
/// false where there are none. Ends that a user or the plant has set stay.
bool widen_strained(const ModelStage& stage, DiagnosisProblem& problem);

/// Makes the ranges of all plant parameters that are more than guesses so many times as wide, the
/// priors unchanged; ends that a user or the plant has set stay.
void widen_all(double times, DiagnosisProblem& problem);

}  // namespace estimator::greybox::selection
