// Is what the innovations still hold a disturbance, or physics? A score test: curves over variables
// of the motion, each entering the equations at one site, against the model's own freedom.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/residual_input.h"

namespace estimator::greybox::selection {

struct CurveGain {
  std::string site;      ///< "flow", "gain", "force"
  std::string variable;  ///< "y", "v", "u", "speed", ...
  double gain_nats = 0.0;
  ResidualInput input = ResidualInput::flow;
};

/// One per site and variable, best first. `stage` has its Jacobian.
[[nodiscard]] std::vector<CurveGain> curve_gains(const InnovationStage& stage);

}  // namespace estimator::greybox::selection
