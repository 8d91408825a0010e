#include "estimator/greybox/selection/revived_refinements.h"

#include <algorithm>
#include <string>

#include "config/units/quantity.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

double typical_of(const FreeParameter& parameter) {
  const plant_sim::EffectInfo* effect = plant_sim::find_effect(effect_of(parameter));
  if (effect == nullptr) return parameter.unit;
  for (const plant_sim::ParameterInfo& info : effect->parameters) {
    if (parameter.name == effect->name + "." + info.name) return info.typical;
  }
  return parameter.unit;
}

/// theta of a parameter in the library's proportion to a size of its effect.
double in_proportion(const FreeParameter& parameter, const FreeParameter& size, double size_theta) {
  return parameter.to_theta(size.to_physical(size_theta) / typical_of(size) *
                            typical_of(parameter));
}

}  // namespace

std::vector<Eigen::VectorXd> revived_refinements(const FitSummary& fitted) {
  std::vector<Eigen::VectorXd> starts;
  const std::vector<FreeParameter>& all = fitted.parameters;
  if (fitted.jacobian.cols() != static_cast<Eigen::Index>(all.size())) return starts;
  const auto is_dead = [&](std::size_t i) {
    return all[i].refinement > 0 &&
           fitted.jacobian.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() == 0.0;
  };
  for (const double share : {1.0, 1.0 / 3.0, 3.0}) {
    Eigen::VectorXd start = fitted.theta;
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::size_t first = 0;
      while (effect_of(all[first]) != effect_of(all[i])) ++first;
      const auto with_it = [&](std::size_t k) {
        return is_dead(k) && all[k].refinement == all[i].refinement &&
               effect_of(all[k]) == effect_of(all[i]);
      };
      bool revive = false;
      for (std::size_t k = first; k < all.size() && !revive; ++k) revive = with_it(k);
      if (!revive) continue;
      const bool same_unit =
          config::units::unit_of(all[i].name) == config::units::unit_of(all[first].name);
      const auto at = static_cast<Eigen::Index>(i);
      const double value = same_unit ? in_proportion(all[i], all[first],
                                                     fitted.theta[static_cast<Eigen::Index>(first)])
                                     : share;
      start[at] = std::clamp(value, all[i].lower, all[i].upper);
      any = true;
    }
    if (any) starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace estimator::greybox::selection
