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

/// Gain of a curve over a variable of the motion above which physics is missing. The largest of 32
/// curves stays below 25 on healthy and rightly named records.
inline constexpr double kCurve_nats = 30.0;

/// Gain of the best curve; 0: there is none.
[[nodiscard]] double largest_curve_nats(const InnovationStage& stage);
/// True where that curve shows that physics is missing.
[[nodiscard]] bool leaves_physics(const InnovationStage& stage);
/// True where that curve gains several times what it may beside a mere remainder. `inexact_nats`:
/// gains that inexact models of what was explained may owe.
[[nodiscard]] bool leaves_much_physics(const InnovationStage& stage, double inexact_nats);

}  // namespace estimator::greybox::selection
