// Where a residual enters the equations, and which variable it goes with: what is left to say when
// no effect of the library explains a record.
//
//   r ~ -J a - sum b_i s_i,     s_i = response to the disturbance  f(t) h_i(x(t))
//
// r residual of the stage, J its Jacobian (the model's parameters may adjust, held by their
// priors), h_i the pieces of a variable x (residual_variables.h). A disturbance enters as
//
//   flow         h_i volts beside the command
//   gain         u h_i volts beside the command
//   force        h_i newtons, or v h_i, against extension
//   measurement  h_i metres, or (y - mean) h_i, on the reading
//
// and the model, simulated with it, gives s_i; on the reading the observer alone answers,
// s / (s + l). a and b are fitted to the fitted samples and scored on the others.
#pragma once

#include <vector>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// One entry for each variable, with the class in which it explains most; best first, of those that
/// do about as well the one with the fewest pieces. Empty when the workshop's cancel says so. The
/// stage's Jacobian must be that of its values.
[[nodiscard]] std::vector<Localisation> localise(const SearchContext& context,
                                                 const ModelStage& stage);

}  // namespace estimator::greybox::selection
