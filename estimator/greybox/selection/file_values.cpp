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

/// The plant's parameter of that name; null for one of an effect.
const plant_sim::ParameterInfo* find_info(const plant_sim::PlantInfo& plant,
                                          const std::string& name) {
  const auto info = std::find_if(plant.parameters.begin(), plant.parameters.end(),
                                 [&](const auto& one) { return one.name == name; });
  return info == plant.parameters.end() ? nullptr : &*info;
}

/// Widens an end of the range that is the prior's own, as far as the plant's limits allow.
bool widen_upper(const plant_sim::ParameterInfo& info, double times, FreeParameter& p) {
  if (!of_prior(p.upper, p.prior_sd)) return false;
  p.upper = std::min(times * p.upper, p.to_theta(info.max));
  return true;
}
bool widen_lower(const plant_sim::ParameterInfo& info, double times, FreeParameter& p) {
  if (!of_prior(p.lower, p.prior_sd)) return false;
  p.lower = info.min > 0.0 ? std::max(times * p.lower, p.to_theta(info.min)) : times * p.lower;
  return true;
}

/// True for a value that is more than a guess.
bool is_known(const FreeParameter& p) { return p.prior_sd > 0.0 && p.prior_sd <= kGuess; }

}  // namespace

bool widen_strained(const ModelStage& stage, DiagnosisProblem& problem) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(problem.model.plant);
  bool any = false;
  for (FreeParameter& p : problem.plant_parameters) {
    const plant_sim::ParameterInfo* const info = find_info(plant, p.name);
    if (!is_known(p) || info == nullptr) continue;
    for (std::size_t i = 0; i < stage.fitted.parameters.size(); ++i) {
      if (stage.fitted.parameters[i].name != p.name) continue;
      const double theta = stage.fitted.theta[static_cast<Eigen::Index>(i)];
      const double margin = kAtEnd * p.prior_sd;
      if (theta >= p.upper - margin) {
        any |= widen_upper(*info, kWider, p);
      } else if (theta <= p.lower + margin) {
        any |= widen_lower(*info, kWider, p);
      }
    }
  }
  return any;
}

void widen_all(double times, DiagnosisProblem& problem) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(problem.model.plant);
  for (FreeParameter& p : problem.plant_parameters) {
    const plant_sim::ParameterInfo* const info = find_info(plant, p.name);
    if (!is_known(p) || info == nullptr) continue;
    (void)widen_upper(*info, times, p);
    (void)widen_lower(*info, times, p);
  }
}

}  // namespace estimator::greybox::selection
