#include "estimator/greybox/selection/revived_refinements.h"

#include <algorithm>
#include <optional>
#include <string>

#include "config/units/quantity.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

/// The parameter that gives an effect its size: the first of the library.
struct Size {
  double value = 0.0;    ///< fitted, or the model's where it is not free
  double typical = 0.0;  ///< the library's
  std::string unit;
};

std::optional<Size> size_of(const plant_sim::ModelFile& model, const plant_sim::EffectInfo& effect,
                            const FitSummary& fitted) {
  const plant_sim::ParameterInfo& first = effect.parameters.front();
  const std::string name = effect.name + "." + first.name;
  Size size{0.0, first.typical, config::units::unit_of(name)};
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (fitted.parameters[i].name != name) continue;
    size.value = fitted.parameters[i].to_physical(fitted.theta[static_cast<Eigen::Index>(i)]);
    return size;
  }
  plant_sim::ModelFile copy = model;
  const double* value = copy.value(name);
  if (value == nullptr || *value == 0.0) return {};
  size.value = *value;
  return size;
}

/// theta of a parameter in the library's proportion to the size of its effect; none where their
/// units differ.
std::optional<double> in_proportion(const plant_sim::ModelFile& model,
                                    const FreeParameter& parameter, const FitSummary& fitted) {
  const plant_sim::EffectInfo* effect = plant_sim::find_effect(effect_of(parameter));
  if (effect == nullptr) return {};
  const std::optional<Size> size = size_of(model, *effect, fitted);
  if (!size || config::units::unit_of(parameter.name) != size->unit) return {};
  for (const plant_sim::ParameterInfo& info : effect->parameters) {
    if (parameter.name != effect->name + "." + info.name) continue;
    return parameter.to_theta(size->value / size->typical * info.typical);
  }
  return {};
}

}  // namespace

std::vector<Eigen::VectorXd> revived_refinements(const plant_sim::ModelFile& model,
                                                 const FitSummary& fitted) {
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
      const auto at = static_cast<Eigen::Index>(i);
      const double value = in_proportion(model, all[i], fitted).value_or(share);
      start[at] = std::clamp(value, all[i].lower, all[i].upper);
      any = true;
    }
    if (any) starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace estimator::greybox::selection
