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

/// Ends of a logarithmic range that are the prior's own: those that a user or the plant has set
/// stay.
bool of_prior(double end, double prior_sd) {
  return std::abs(std::abs(end) - kPriorRange_sds * prior_sd) < 1e-9;
}

/// Widens the range at the end that theta has reached, as far as the plant's own limits allow.
bool widen(const plant_sim::PlantInfo& plant, double theta, FreeParameter& p) {
  const auto info = std::find_if(plant.parameters.begin(), plant.parameters.end(),
                                 [&](const auto& one) { return one.name == p.name; });
  if (info == plant.parameters.end()) return false;
  const double margin = kAtEnd * p.prior_sd;
  if (theta >= p.upper - margin && of_prior(p.upper, p.prior_sd)) {
    p.upper = std::min(kWider * p.upper, p.to_theta(info->max));
    return true;
  }
  if (theta <= p.lower + margin && of_prior(p.lower, p.prior_sd)) {
    p.lower =
        info->min > 0.0 ? std::max(kWider * p.lower, p.to_theta(info->min)) : kWider * p.lower;
    return true;
  }
  return false;
}

}  // namespace

bool widen_strained(const ModelStage& stage, DiagnosisProblem& problem) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(problem.model.plant);
  bool any = false;
  for (FreeParameter& p : problem.plant_parameters) {
    if (!(p.prior_sd > 0.0 && p.prior_sd <= kGuess)) continue;
    for (std::size_t i = 0; i < stage.fitted.parameters.size(); ++i) {
      if (stage.fitted.parameters[i].name != p.name) continue;
      if (widen(plant, stage.fitted.theta[static_cast<Eigen::Index>(i)], p)) any = true;
    }
  }
  return any;
}

}  // namespace estimator::greybox::selection
