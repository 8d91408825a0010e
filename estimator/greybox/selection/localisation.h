// Localisation of a residual: the site at which it enters the equations and the variable it
// correlates with. Used when no effect of the library explains a record.
//
//   r ~ -J a - sum b_i s_i,     s_i = response to the disturbance  f(t) h_i(x(t))
//
// r residual of the stage, J its Jacobian (the parameters may adjust, held by their priors), h_i
// the pieces of a variable x (residual_variables.h). A disturbance enters as
//
//   flow         h_i volts beside the command
//   gain         u h_i volts beside the command
//   force        h_i newtons, or v h_i, against extension
//   measurement  h_i metres, or (y - mean) h_i, on the reading
//
// and the model, simulated with it, gives s_i; for the reading the observer alone responds, with
// s / (s + l). a and b are fitted to the training samples and scored on the others.
//
// A lag between command and reading shifts the reading by a polynomial of the rod's speed,
// acceleration and jerk, as an error of the measurement that goes with these does: from command and
// position the two are one.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Site at which a residual enters the equations and the variable it correlates with.
struct Localisation {
  std::string site;              ///< "flow", "force", "gain", "measurement"
  std::string variable;          ///< "y", "v", "u", "speed", "acceleration", "time", "direction"
  double explained_ratio = 0.0;  ///< share of the held-out squared error
  /// Other sites that explain about as much, with this variable or another, best first; "lag": one
  /// between command and reading. The record does not tell `site` from these.
  std::vector<std::string> or_sites = {};
};

/// One entry per variable, with the site that explains most, best first; among about equal entries
/// the one with the fewest pieces. Empty when cancelled. Requires the stage's Jacobian at its
/// theta.
[[nodiscard]] std::vector<Localisation> localise(const SearchContext& context,
                                                 const ModelStage& stage);

}  // namespace estimator::greybox::selection
