#include "estimator/greybox/selection/problem.h"

#include <algorithm>

#include "estimator/greybox/selection/typical_sizes.h"

namespace estimator::greybox::selection {

using plant_sim::EffectInfo;
using plant_sim::ModelFile;

std::vector<EffectInfo> absent_effects(const ModelFile& model) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(model.plant);
  const auto fits = [&](const EffectInfo& effect) {
    return std::all_of(effect.sites.begin(), effect.sites.end(), [&](const std::string& site) {
      return std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end();
    });
  };
  const auto acts = [&](const EffectInfo& effect) {
    for (const ModelFile::Effect& entry : model.effects) {
      if (entry.name != effect.name || !entry.present) continue;
      for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
        if (entry.parameters[i].value != effect.parameters[i].neutral) return true;
      }
    }
    return false;
  };
  std::vector<EffectInfo> absent;
  for (const EffectInfo& effect : plant_sim::effects_of(model)) {
    if (fits(effect) && !acts(effect)) absent.push_back(effect);
  }
  return absent;
}

DiagnosisProblem make_problem(ModelFile model, FitDataset data) {
  DiagnosisProblem result;
  result.candidate_effects = absent_effects(model);
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
