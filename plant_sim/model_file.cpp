#include "plant_sim/model_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/visitor.h"
#include "plant_sim/formula/curve_effect.h"
#include "plant_sim/library.h"
#include "plant_sim/model_checks.h"

namespace plant_sim {
namespace {

using config::schema::Visitor;

constexpr double kWidestPrior = 10.0;

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

std::vector<NamedValue> unstated(std::vector<NamedValue> values) {
  for (NamedValue& value : values) value.value = std::numeric_limits<double>::quiet_NaN();
  return values;
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

/// A number of a change: "mass_kg.at_s".
double* find(std::vector<Change>& changes, std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return nullptr;
  const std::string_view number = name.substr(dot + 1);
  for (Change& change : changes) {
    if (change.parameter != name.substr(0, dot)) continue;
    if (number == "value") return &change.value;
    if (number == "at_s") return &change.at_s;
    if (number == "ramp_s") return &change.ramp_s;
    if (number == "time_constant_s") return &change.time_constant_s;
  }
  return nullptr;
}

bool is_curve(const formula::FormulaEffect& effect) { return effect.curve.has_value(); }

}  // namespace

ModelFile::ModelFile() {
  const PlantInfo& info = *find_plant(plant);
  parameters = defaults(info.parameters);
  priors = unstated(parameters);
  initial = defaults(info.initial);
  list_effects();
}

/// Matches `effects` with the declared ones; effects that stay keep their values.
void ModelFile::list_effects() {
  const std::vector<Effect> before = std::move(effects);
  effects.clear();
  for (const EffectInfo& info : effects_of(*this)) {
    Effect entry{info.name, false, defaults(info.parameters)};
    const auto same_name = [](const NamedValue& a, const NamedValue& b) {
      return a.name == b.name;
    };
    const auto old = std::find_if(before.begin(), before.end(), [&](const Effect& one) {
      return one.name == entry.name &&
             std::equal(one.parameters.begin(), one.parameters.end(), entry.parameters.begin(),
                        entry.parameters.end(), same_name);
    });
    effects.push_back(old == before.end() ? std::move(entry) : *old);
  }
}

void ModelFile::visit(Visitor& v) {
  v.text({"name", "the model's name", true}, name);
  const std::string before = plant;
  v.choice({"plant", "plant of the model", true}, plant, plant_names());
  const PlantInfo& info = *find_plant(plant);
  if (plant != before) {
    parameters = defaults(info.parameters);
    priors = unstated(parameters);
    initial = defaults(info.initial);
  }
  v.choice({"motion", "kind of the axis; rotary: `_m` is rad, `_N` is N m, `_kg` is kg m2"}, motion,
           {"linear", "rotary"});
  v.number({"step_s", "integration step"}, step_s, {1e-6, 0.01});
  v.table("parameters", [&](Visitor& t) { visit_values(t, info.parameters, parameters); });
  v.table({"priors", "relative standard deviations of parameters; 0 holds one in every fit"},
          [&](Visitor& t) {
            for (std::size_t i = 0; i < priors.size(); ++i) {
              t.number({info.parameters[i].name, "relative standard deviation"}, priors[i].value,
                       {0.0, kWidestPrior});
            }
          });
  v.table("initial", [&](Visitor& t) { visit_values(t, info.initial, initial); });
  std::vector<formula::FormulaEffect> curves = take_curves();
  std::vector<std::string> declared;
  for (const formula::FormulaEffect& effect : formula_effects) declared.push_back(effect.name);
  declared = v.names("formula_effects", declared);
  formula_effects.resize(declared.size());
  v.table("formula_effects", [&](Visitor& t) {
    for (std::size_t i = 0; i < declared.size(); ++i) {
      formula_effects[i].name = declared[i];
      t.table(declared[i].c_str(), [&](Visitor& f) { formula_effects[i].visit(f); });
    }
  });
  visit_curves(v, std::move(curves));
  const std::vector<EffectInfo> all = effects_of(*this);
  v.table("effects", [&](Visitor& t) {
    const std::size_t library = all.size() - formula_effects.size();
    for (std::size_t i = 0; i < effects.size(); ++i) {
      if (i >= library && is_curve(formula_effects[i - library])) continue;
      t.optional_table(effects[i].name.c_str(), effects[i].present, [&](Visitor& e) {
        visit_values(e, all[i].parameters, effects[i].parameters);
      });
      for (const auto& [further, known] : further_names()) {
        if (effects[i].name != known) continue;
        bool further_present = false;
        t.optional_table(further, further_present, [&](Visitor& e) {
          visit_values(e, all[i].parameters, effects[i].parameters);
        });
        effects[i].present = effects[i].present || further_present;
      }
    }
  });
  visit_list(v, {"change", "changes of parameters within a record"}, changes);
  v.table("loop", [&](Visitor& t) {
    t.number({"kp_V_per_m", "gain of the proportional controller"}, loop.kp_V_per_m, {0.0, 1e6});
  });
}

/// Removes the curves from the formulas; their tables have the values of the effects that they are.
std::vector<formula::FormulaEffect> ModelFile::take_curves() {
  std::vector<formula::FormulaEffect> curves;
  for (formula::FormulaEffect& effect : formula_effects) {
    if (!is_curve(effect)) continue;
    effect.curve->f.clear();
    for (const Effect& entry : effects) {
      if (entry.name != effect.name) continue;
      for (const NamedValue& p : entry.parameters) {
        effect.curve->f.push_back(entry.present ? p.value : 0.0);
      }
    }
    curves.push_back(std::move(effect));
  }
  std::erase_if(formula_effects, is_curve);
  return curves;
}

/// The tables of curves, which join the formulas; the effects that they are have their values.
void ModelFile::visit_curves(Visitor& v, std::vector<formula::FormulaEffect> curves) {
  std::vector<std::string> names;
  for (const formula::FormulaEffect& curve : curves) names.push_back(curve.name);
  names = v.names("curve_effects", names);
  curves.resize(names.size());
  v.table("curve_effects", [&](Visitor& t) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      curves[i].name = names[i];
      if (!curves[i].curve) curves[i].curve.emplace();
      t.table(names[i].c_str(), [&](Visitor& c) { curves[i].visit(c); });
    }
  });
  formula_effects.insert(formula_effects.end(), curves.begin(), curves.end());
  list_effects();
  for (const formula::FormulaEffect& curve : curves) {
    const std::size_t count = std::min(curve.curve->f.size(), curve.parameters.size());
    for (std::size_t i = 0; i < count; ++i) {
      *value(curve.name + "." + curve.parameters[i].name) = curve.curve->f[i];
    }
  }
}

void ModelFile::declare(const formula::FormulaEffect& effect, const std::string& file) {
  check_declared(*this, effect, file);
  const auto same = [&](const formula::FormulaEffect& other) { return other.name == effect.name; };
  const auto old = std::find_if(formula_effects.begin(), formula_effects.end(), same);
  if (old == formula_effects.end()) {
    formula_effects.push_back(effect);
  } else {
    *old = effect;
    std::erase_if(effects, [&](const Effect& entry) { return entry.name == effect.name; });
  }
  list_effects();
}

formula::Formulas ModelFile::formulas() const {
  std::vector<formula::Formula> all;
  all.reserve(formula_effects.size());
  for (const formula::FormulaEffect& effect : formula_effects) {
    all.push_back(formula::compile(effect, plausible_ranges(*this), table_of(effect, name)));
  }
  return formula::Formulas(std::move(all));
}

double ModelFile::uncertainty_ratio(std::size_t i) const {
  return std::isnan(priors[i].value) ? find_plant(plant)->parameters[i].uncertainty_ratio
                                     : priors[i].value;
}

double* ModelFile::value(std::string_view typed) {
  const std::string dotted = library_name(typed);
  const std::size_t dot = dotted.find('.');
  if (dot == std::string::npos) return find(parameters, dotted);
  const std::string table = dotted.substr(0, dot);
  const std::string key = dotted.substr(dot + 1);
  if (table == "initial") return find(initial, key);
  if (table == "change") return find(changes, key);
  for (Effect& effect : effects) {
    if (effect.name != table) continue;
    double* found = find(effect.parameters, key);
    effect.present = effect.present || found != nullptr;
    return found;
  }
  return nullptr;
}

ModelFile without_changes(ModelFile model) {
  model.changes.clear();
  return model;
}

void require_constant(const ModelFile& model) {
  if (model.changes.empty()) return;
  throw config::schema::bad_config(model.name, "has a [[change]], which belongs to one record",
                                   "none in the model of a rig that runs");
}

ModelFile load_model(const std::filesystem::path& file,
                     const std::vector<std::string>& assignments) {
  auto document = config::schema::Document::load(file);
  for (const std::string& assignment : assignments) document.set(assignment);
  return read_model(document);
}

ModelFile read_model(const config::schema::Document& document) {
  ModelFile model;
  document.read([&](Visitor& v) { model.visit(v); });
  check_model(model, document.name());
  return model;
}

ModelFile stated_values(const ModelFile& model, const config::schema::Document& document) {
  ModelFile stated = model;
  stated.parameters = unstated(model.parameters);
  stated.initial = unstated(model.initial);
  for (ModelFile::Effect& effect : stated.effects) effect.parameters = unstated(effect.parameters);
  document.read([&](Visitor& v) { stated.visit(v); });
  return stated;
}

std::string print_model(const ModelFile& model) {
  ModelFile copy = model;
  return config::schema::print_toml([&](Visitor& v) { copy.visit(v); });
}

}  // namespace plant_sim
