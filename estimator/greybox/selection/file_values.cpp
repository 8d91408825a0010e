#include "estimator/greybox/selection/file_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kWider = 2.0;
/// Uncertainty above which a value is a guess, whose range holds all that is plausible.
constexpr double kGuess = 0.5;
/// Distance from the end of the range, in standard deviations of the prior.
constexpr double kAtEnd = 0.01;

/// Widens a logarithmic range as far as the plant's own limits of the parameter allow.
void widen(const plant_sim::PlantInfo& plant, FreeParameter& p) {
  for (const plant_sim::ParameterInfo& info : plant.parameters) {
    if (info.name != p.name) continue;
    p.upper = std::min(kWider * p.upper, p.to_theta(info.max));
    p.lower = info.min > 0.0 ? std::max(kWider * p.lower, p.to_theta(info.min)) : kWider * p.lower;
  }
}

}  // namespace

bool widen_strained(const ModelStage& stage, DiagnosisProblem& problem) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(problem.model.plant);
  bool any = false;
  for (FreeParameter& p : problem.plant_parameters) {
    if (!(p.prior_sd > 0.0 && p.prior_sd <= kGuess)) continue;
    for (std::size_t i = 0; i < stage.fitted.parameters.size(); ++i) {
      if (stage.fitted.parameters[i].name != p.name) continue;
      const double theta = stage.fitted.theta[static_cast<Eigen::Index>(i)];
      const double margin = kAtEnd * p.prior_sd;
      if (theta > p.lower + margin && theta < p.upper - margin) continue;
      widen(plant, p);
      any = true;
    }
  }
  return any;
}

}  // namespace estimator::greybox::selection
