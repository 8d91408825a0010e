// spoolwatch effects: the library of physical effects, and what a model file adds to it by
// formulas, for reading and as JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "config/units/quantity.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {
namespace {

using nlohmann::ordered_json;
using plant_sim::EffectInfo;
using plant_sim::ParameterInfo;
using plant_sim::PlantInfo;
using present::number_or_null;

bool fits(const EffectInfo& effect, const PlantInfo& plant) {
  return std::all_of(effect.sites.begin(), effect.sites.end(), [&](const std::string& site) {
    return std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end();
  });
}

std::vector<std::string> plants_of(const EffectInfo& effect) {
  std::vector<std::string> names;
  for (const PlantInfo& plant : plant_sim::plant_library()) {
    if (fits(effect, plant)) names.push_back(plant.name);
  }
  return names;
}

std::string printed_unit(const char* name) {
  return config::units::axis_unit(config::units::unit_of(name));
}

ordered_json json_of(const std::vector<ParameterInfo>& parameters, const char* last) {
  ordered_json list = ordered_json::array();
  for (const ParameterInfo& p : parameters) {
    list.push_back({{"name", p.name},
                    {"what", p.what},
                    {"unit", printed_unit(p.name)},
                    {"min", number_or_null(p.min)},
                    {"max", number_or_null(p.max)},
                    {"typical", number_or_null(p.typical)},
                    {last, number_or_null(p.neutral)}});
  }
  return list;
}

ordered_json library_json(const std::vector<EffectInfo>& listed) {
  ordered_json effects = ordered_json::array();
  for (const EffectInfo& effect : listed) {
    effects.push_back({{"name", effect.name},
                       {"equation", effect.equation},
                       {"sites", effect.sites},
                       {"plants", plants_of(effect)},
                       {"dissipative", effect.dissipative},
                       {"parameters", json_of(effect.parameters, "neutral")}});
    if (!effect.what.empty()) effects.back()["what"] = effect.what;
  }
  ordered_json plants = ordered_json::array();
  for (const PlantInfo& plant : plant_sim::plant_library()) {
    plants.push_back({{"name", plant.name},
                      {"sites", plant.sites},
                      {"parameters", json_of(plant.parameters, "default")}});
  }
  return {{"effects", effects}, {"plants", plants}};
}

void print_library(const std::vector<EffectInfo>& listed) {
  for (const EffectInfo& effect : listed) {
    const std::string what = effect.what.empty() ? "" : "  " + effect.what + "\n";
    std::printf("%s\n  %s\n%s  acts on %s; for %s\n", effect.name.c_str(), effect.equation.c_str(),
                what.c_str(), config::schema::joined(effect.sites).c_str(),
                config::schema::joined(plants_of(effect)).c_str());
    for (const ParameterInfo& p : effect.parameters) {
      const std::string unit = printed_unit(p.name);
      std::printf("    %-30s %g to %g%s%s, typically %g: %s\n", p.name, p.min, p.max,
                  unit.empty() ? "" : " ", unit.c_str(), p.typical,
                  config::units::axis_words(p.what).c_str());
    }
  }
}

/// Throws where `word` is neither an effect of the library nor, by its looks, a model file.
const EffectInfo* effect_named(const std::string& word) {
  if (const EffectInfo* effect = plant_sim::find_effect(word)) return effect;
  std::error_code ignored;
  if (word.ends_with(".toml") || std::filesystem::exists(word, ignored)) return nullptr;
  std::vector<std::string> names;
  for (const EffectInfo& effect : plant_sim::effect_library()) names.push_back(effect.name);
  const std::string near = config::schema::nearest(word, names);
  throw config::schema::UsageError("effects: " + word +
                                   " is neither an effect of the library nor a model file" +
                                   (near.empty() ? "" : ", did you mean " + near + "?"));
}

void list_effects(const std::vector<EffectInfo>& listed, const std::string& json) {
  if (json.empty()) return print_library(listed);
  present::write_json(library_json(listed).dump(2) + "\n", json);
}

}  // namespace

void add_effects(CLI::App& command, int&) {
  auto json = std::make_shared<std::string>();
  auto model = std::make_shared<std::string>();
  command.add_option("MODEL", *model,
                     "a model file, to list its own effects too; or an effect, to list it alone");
  add_json(command, *json);
  command.callback([json, model] {
    if (model->empty()) return list_effects(plant_sim::effect_library(), *json);
    if (const EffectInfo* effect = effect_named(*model)) return list_effects({*effect}, *json);
    const plant_sim::ModelFile file = plant_sim::load_model(*model);
    const present::PrintedAxis axis(present::motion_of(file));
    list_effects(plant_sim::effects_of(file), *json);
  });
}

}  // namespace workbench::cli
