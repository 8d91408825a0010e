#include "estimator/greybox/selection/problem.h"

#include <algorithm>
#include <set>

#include "estimator/greybox/selection/screening.h"
#include "estimator/greybox/selection/typical_sizes.h"

namespace estimator::greybox::selection {

using plant_sim::EffectInfo;
using plant_sim::ModelFile;
using plant_sim::ParameterInfo;

bool has_effect(const ModelFile& model, const EffectInfo& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [&](const ParameterInfo& p) { return is_given(model, effect.name, p); });
}

std::vector<EffectInfo> absent_effects(const ModelFile& model) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(model.plant);
  const auto fits = [&](const EffectInfo& effect) {
    return std::all_of(effect.sites.begin(), effect.sites.end(), [&](const std::string& site) {
      return std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end();
    });
  };
  std::vector<EffectInfo> absent;
  for (const EffectInfo& effect : plant_sim::effects_of(model)) {
    if (fits(effect) && !has_effect(model, effect)) absent.push_back(effect);
  }
  return absent;
}

std::vector<std::string> names_of(const std::vector<EffectInfo>& effects) {
  std::vector<std::string> names;
  names.reserve(effects.size());
  for (const EffectInfo& effect : effects) names.push_back(effect.name);
  return names;
}

void give_size(EffectInfo& refinements) {
  const auto first = std::min_element(
      refinements.parameters.begin(), refinements.parameters.end(),
      [](const ParameterInfo& a, const ParameterInfo& b) { return a.refinement < b.refinement; });
  if (first == refinements.parameters.end() || first->refinement <= kFirstRefinements) return;
  const int number = first->refinement;
  for (ParameterInfo& p : refinements.parameters) {
    if (p.refinement == number) p.refinement = 0;
  }
}

std::vector<EffectInfo> lacking_refinements(const ModelFile& model) {
  std::vector<EffectInfo> found;
  for (EffectInfo effect : plant_sim::effect_library()) {
    if (!has_effect(model, effect)) continue;
    std::set<int> given;
    for (const ParameterInfo& p : effect.parameters) {
      if (is_given(model, effect.name, p)) given.insert(p.refinement);
    }
    std::erase_if(effect.parameters, [&](const ParameterInfo& p) {
      return p.refinement == 0 || given.count(p.refinement) != 0 ||
             (p.instead_of > 0 && given.count(p.instead_of) != 0);
    });
    if (effect.parameters.empty()) continue;
    give_size(effect);
    found.push_back(std::move(effect));
  }
  return found;
}

DiagnosisProblem make_problem(ModelFile model, FitDataset data) {
  DiagnosisProblem result;
  result.candidate_effects = absent_effects(model);
  for (EffectInfo& effect : lacking_refinements(model)) {
    result.candidate_effects.push_back(std::move(effect));
  }
  scale_typical_sizes(model, data, result.candidate_effects);
  result.plant_parameters = plant_parameters(model);
  for (FreeParameter& p : present_parameters(model)) {
    result.plant_parameters.push_back(std::move(p));
  }
  result.model = std::move(model);
  result.data = std::move(data);
  return result;
}

}  // namespace estimator::greybox::selection
