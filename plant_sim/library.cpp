#include "plant_sim/library.h"

#include "plant_sim/plants.h"

namespace plant_sim {
namespace {

template <class Fields>
std::vector<ParameterInfo> listed() {
  Fields fields;
  std::vector<ParameterInfo> all;
  fields.visit([&](const ParameterInfo& info, double&) { all.push_back(info); });
  return all;
}

}  // namespace

const std::vector<EffectInfo>& effect_library() {
  static const std::vector<EffectInfo> library = [] {
    std::vector<EffectInfo> all;
    Effects<double> effects;
    effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      EffectInfo info{Effect::kName, Effect::kEquation, {}, Effect::kDissipative, {}};
      for (const Site site : Effect::kSites) info.sites.emplace_back(site_name(site));
      parameters.visit(
          [&](const ParameterInfo& parameter, double&) { info.parameters.push_back(parameter); });
      all.push_back(std::move(info));
    });
    return all;
  }();
  return library;
}

const std::vector<PlantInfo>& plant_library() {
  static const std::vector<PlantInfo> library = [] {
    std::vector<PlantInfo> all;
    each_plant([&]<class Model>() {
      all.push_back(
          {Model::kName, listed<typename Model::Parameters>(), listed<typename Model::Initial>()});
    });
    return all;
  }();
  return library;
}

const PlantInfo* find_plant(std::string_view name) {
  for (const PlantInfo& plant : plant_library()) {
    if (plant.name == name) return &plant;
  }
  return nullptr;
}

}  // namespace plant_sim
