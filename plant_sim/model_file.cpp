#include "plant_sim/model_file.h"

#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "plant_sim/library.h"

namespace plant_sim {
namespace {

using config::schema::Visitor;

std::vector<NamedValue> defaults(const std::vector<ParameterInfo>& infos) {
  std::vector<NamedValue> values;
  values.reserve(infos.size());
  for (const ParameterInfo& info : infos) values.push_back({info.name, info.neutral});
  return values;
}

void visit_values(Visitor& v, const std::vector<ParameterInfo>& infos,
                  std::vector<NamedValue>& values) {
  for (std::size_t i = 0; i < infos.size(); ++i) {
    v.number({infos[i].name, infos[i].what}, values[i].value, {infos[i].min, infos[i].max});
  }
}

std::vector<std::string_view> plant_names() {
  std::vector<std::string_view> names;
  names.reserve(plant_library().size());
  for (const PlantInfo& plant : plant_library()) names.emplace_back(plant.name);
  return names;
}

double* find(std::vector<NamedValue>& values, std::string_view name) {
  for (NamedValue& value : values) {
    if (value.name == name) return &value.value;
  }
  return nullptr;
}

}  // namespace

ModelFile::ModelFile() {
  const PlantInfo& info = *find_plant(plant);
  parameters = defaults(info.parameters);
  initial = defaults(info.initial);
  for (const EffectInfo& effect : effect_library()) {
    effects.push_back({effect.name, false, defaults(effect.parameters)});
  }
}

void ModelFile::visit(Visitor& v) {
  v.text({"name", "the model's name", true}, name);
  const std::string before = plant;
  v.choice({"plant", "which plant", true}, plant, plant_names());
  const PlantInfo& info = *find_plant(plant);
  if (plant != before) {
    parameters = defaults(info.parameters);
    initial = defaults(info.initial);
  }
  v.number({"step_s", "integration step"}, step_s, {1e-6, 0.01});
  v.table("parameters", [&](Visitor& t) { visit_values(t, info.parameters, parameters); });
  v.table("initial", [&](Visitor& t) { visit_values(t, info.initial, initial); });
  v.table("effects", [&](Visitor& t) {
    for (std::size_t i = 0; i < effects.size(); ++i) {
      t.optional_table(effects[i].name.c_str(), effects[i].present, [&](Visitor& e) {
        visit_values(e, effect_library()[i].parameters, effects[i].parameters);
      });
    }
  });
  v.table("loop", [&](Visitor& t) {
    t.number({"kp_V_per_m", "gain of the proportional controller"}, loop.kp_V_per_m, {0.0, 1e6});
  });
}

double* ModelFile::value(std::string_view dotted) {
  const std::size_t dot = dotted.find('.');
  if (dot == std::string_view::npos) return find(parameters, dotted);
  const std::string_view table = dotted.substr(0, dot);
  const std::string_view key = dotted.substr(dot + 1);
  if (table == "initial") return find(initial, key);
  for (Effect& effect : effects) {
    if (effect.name != table) continue;
    double* found = find(effect.parameters, key);
    effect.present = effect.present || found != nullptr;
    return found;
  }
  return nullptr;
}

ModelFile load_model(const std::filesystem::path& file) {
  return read_model(config::schema::Document::load(file));
}

ModelFile read_model(const config::schema::Document& document) {
  ModelFile model;
  document.read([&](Visitor& v) { model.visit(v); });
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    if (!model.effects[i].present) continue;
    require_fit(effect_library()[i], *find_plant(model.plant),
                document.name() + ": [effects." + model.effects[i].name + "]");
  }
  const double* stroke_m = model.value("stroke_m");
  if (stroke_m != nullptr && *model.value("initial.y_m") > *stroke_m) {
    throw config::schema::bad_config(document.name() + ": [initial] y_m", "is beyond the stroke",
                                     "0 to stroke_m");
  }
  return model;
}

std::string print_model(const ModelFile& model) {
  ModelFile copy = model;
  return config::schema::print_toml([&](Visitor& v) { copy.visit(v); });
}

}  // namespace plant_sim
