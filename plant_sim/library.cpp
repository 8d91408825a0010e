#include "plant_sim/library.h"

#include <algorithm>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "plant_sim/formula/formula.h"
#include "plant_sim/model_file.h"
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

template <class Type>
std::vector<std::string> site_names() {
  std::vector<std::string> names;
  names.reserve(Type::kSites.size());
  for (const effects::Site site : Type::kSites) names.emplace_back(effects::site_name(site));
  return names;
}

template <class Info>
const Info* find(const std::vector<Info>& library, std::string_view name) {
  for (const Info& info : library) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

}  // namespace

const std::vector<FurtherName>& further_names() {
  static const std::vector<FurtherName> names{{"added_load", "coupled_slaves"}};
  return names;
}

const std::vector<EffectInfo>& effect_library() {
  static const std::vector<EffectInfo> library = [] {
    std::vector<EffectInfo> all;
    effects::Effects<double> effects;
    effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      EffectInfo info{Effect::kName, Effect::kEquation, {}, Effect::kDissipative, {}};
      info.sites = site_names<Effect>();
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
    each_plant<double>([&]<class Model>() {
      all.push_back({Model::kName, site_names<Model>(), listed<typename Model::Parameters>(),
                     listed<typename Model::Initial>()});
    });
    return all;
  }();
  return library;
}

const PlantInfo* find_plant(std::string_view name) { return find(plant_library(), name); }

std::string library_name(std::string_view dotted) {
  const std::string_view effect = dotted.substr(0, dotted.find('.'));
  for (const auto& [further, name] : further_names()) {
    if (effect == further) return std::string(name) + std::string(dotted.substr(effect.size()));
  }
  return std::string(dotted);
}

const EffectInfo* find_effect(std::string_view name) {
  return find(effect_library(), library_name(name));
}

std::vector<EffectInfo> effects_of(const ModelFile& model) {
  std::vector<EffectInfo> all = effect_library();
  for (const formula::FormulaEffect& declared : model.formula_effects) {
    const formula::FormulaSite* site = formula::find_formula_site(declared.site);
    const std::string result = site != nullptr ? std::string(site->result) + " = " : "";
    EffectInfo info{declared.name, result + declared.equation(), {declared.site}, false, {}};
    for (const formula::FormulaEffect::Parameter& p : declared.parameters) {
      info.parameters.push_back(info_of(p));
    }
    info.what = declared.what;
    all.push_back(std::move(info));
  }
  return all;
}

void require_fit(const ModelFile& model, const std::string& file) {
  const PlantInfo* plant = find_plant(model.plant);
  if (plant == nullptr) return;
  const std::vector<EffectInfo> effects = effects_of(model);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const bool formula = i >= effect_library().size();
    if (!formula && !model.effects[i].present) continue;
    require_fit(effects[i], *plant,
                file + (formula ? ": [formula_effects." : ": [effects.") + effects[i].name + "]");
  }
}

void require_fit(const EffectInfo& effect, const PlantInfo& plant, const std::string& where) {
  for (const std::string& site : effect.sites) {
    if (std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end()) continue;
    throw config::schema::bad_config(where,
                                     effect.name + " acts on " + site + ", which " + plant.name +
                                         " does not have" +
                                         (site == effects::site_name(effects::Site::coupling)
                                              ? ": its command sets the speed whatever it carries"
                                              : ""),
                                     "effects of its sites " + config::schema::joined(plant.sites));
  }
}

}  // namespace plant_sim
