#include "plant_sim/model_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "config/schema/error.h"
#include "plant_sim/change.h"
#include "plant_sim/formula/curve_effect.h"
#include "plant_sim/hydraulics.h"
#include "plant_sim/library.h"

namespace plant_sim {
namespace {

/// A value of the plant, whichever plant has it.
double value_or(const ModelFile& model, std::string_view name, double otherwise) {
  for (const NamedValue& value : model.parameters) {
    if (value.name == name) return value.value;
  }
  return otherwise;
}

/// Description of a parameter of the plant or of an effect that fits the plant; null for another
/// name. Takes the names that the library prints.
const ParameterInfo* info_of(const ModelFile& model, const std::vector<EffectInfo>& effects,
                             std::string_view dotted, const std::string& where) {
  const PlantInfo& plant = *find_plant(model.plant);
  const auto among = [](const std::vector<ParameterInfo>& infos, std::string_view name) {
    const auto found = std::find_if(infos.begin(), infos.end(),
                                    [&](const ParameterInfo& info) { return info.name == name; });
    return found == infos.end() ? nullptr : &*found;
  };
  const std::size_t dot = dotted.find('.');
  if (dot == std::string_view::npos) return among(plant.parameters, dotted);
  for (const EffectInfo& effect : effects) {
    if (effect.name != dotted.substr(0, dot)) continue;
    require_fit(effect, plant, where);
    return among(effect.parameters, dotted.substr(dot + 1));
  }
  return nullptr;
}

/// Throws for a prior of a value that has no relative standard deviation: it would free nothing.
void check_priors(const ModelFile& model, const std::string& file) {
  for (std::size_t i = 0; i < model.priors.size(); ++i) {
    const NamedValue& value = model.parameters[i];
    if (!(model.priors[i].value > 0.0) || value.value > 0.0) continue;
    throw config::schema::bad_config(
        fmt::format("{}: [priors] {}", file, value.name),
        fmt::format("is relative to {} = {:g}, which no fit can free", value.name, value.value),
        "no prior, 0, or a value above 0");
  }
}

void require_something_to_change(const ModelFile& model, const Change& change,
                                 const std::string& where) {
  const std::string effect = change.parameter.substr(0, change.parameter.find('.'));
  const auto lacks = [&](const ModelFile::Effect& e) { return e.name == effect && !e.present; };
  if (std::isnan(change.factor) || effect == change.parameter ||
      std::none_of(model.effects.begin(), model.effects.end(), lacks)) {
    return;
  }
  throw config::schema::bad_config(where, "is a factor on an effect that the model lacks",
                                   "value, or an [effects." + effect + "] to change");
}

void require_rod_within(ModelFile& model, double stroke_m, const std::string& where) {
  const double* start_m = model.value("initial.y_m");
  if (start_m == nullptr || *start_m > *model.value("stroke_m") || *start_m <= stroke_m) return;
  throw config::schema::bad_config(
      where, fmt::format("to {:g} leaves the rod beyond the stroke", stroke_m),
      fmt::format("initial.y_m = {:g} or more", *start_m));
}

/// Gives parameters of changes the names that the library prints. Throws unless every change can be
/// simulated and is the only one of its parameter.
void check_changes(ModelFile& model, const std::string& file) {
  const std::vector<EffectInfo> effects = effects_of(model);
  for (std::size_t i = 0; i < model.changes.size(); ++i) {
    Change& change = model.changes[i];
    const std::string where = file + ": [[change]] " + change.parameter;
    change.parameter = library_name(change.parameter);
    const ParameterInfo* info = info_of(model, effects, change.parameter, where);
    if (info == nullptr) {
      throw config::schema::bad_config(where, "is no parameter of plant " + model.plant);
    }
    require_something_to_change(model, change, where);
    ModelFile copy = model;
    const double to = target_of(change, *info, *copy.value(change.parameter), where);
    if (change.parameter == "stroke_m") require_rod_within(copy, to, where);
    for (std::size_t other = 0; other < i; ++other) {
      if (model.changes[other].parameter != change.parameter) continue;
      throw config::schema::bad_config(where, "is there twice", "one change for a parameter");
    }
  }
}

}  // namespace

std::string table_of(const formula::FormulaEffect& effect, const std::string& file) {
  return file + (effect.curve ? ": [curve_effects." : ": [formula_effects.") + effect.name + "]";
}

formula::PlausibleRanges plausible_ranges(const ModelFile& model) {
  constexpr double kFullCommand_V = 10.0;
  formula::PlausibleRanges ranges;
  const std::optional<Hydraulics> oil = hydraulics_of(model);
  const double gain = oil ? oil->valve_gain_m_per_V : value_or(model, "gain_mps_per_V", 1.0);
  const double opening = std::max(kFullCommand_V * gain, 1e-6);
  const double supply_Pa = std::max(oil ? oil->supply_pressure_Pa : 0.0, 1e5);
  const double flow_m3ps =
      std::max((oil ? oil->orifice : 0.0) * opening * std::sqrt(supply_Pa), 1e-9);
  const double stroke_m = value_or(model, "stroke_m", -1.0);
  ranges.opening_m = {-opening, opening};
  ranges.flow_m3ps = {-flow_m3ps, flow_m3ps};
  ranges.pressure_Pa = {0.0, 2.0 * supply_Pa};
  const std::vector<std::string>& sites = find_plant(model.plant)->sites;
  const auto has = [&](const char* site) {
    return std::find(sites.begin(), sites.end(), site) != sites.end();
  };
  ranges.has_opening = has("opening");
  ranges.has_pressures = has("leakage");
  ranges.position_m =
      stroke_m > 0.0 ? formula::VariableRange{0.0, stroke_m} : formula::VariableRange{-2.0, 2.0};
  return ranges;
}

void check_declared(const ModelFile& model, const formula::FormulaEffect& effect,
                    const std::string& file) {
  const std::string where = table_of(effect, file);
  if (find_effect(effect.name) != nullptr || effect.name == "initial") {
    throw config::schema::bad_config(where, "has the name of an effect of the library",
                                     "another name");
  }
  const auto same = [&](const formula::FormulaEffect& other) { return other.name == effect.name; };
  if (std::count_if(model.formula_effects.begin(), model.formula_effects.end(), same) > 1) {
    throw config::schema::bad_config(where, "has the name of another effect of the file",
                                     "another name");
  }
  if (effect.curve) formula::check_points(effect, where);
  check(effect, formula::compile(effect, plausible_ranges(model), where), where);
}

void check_model(ModelFile& model, const std::string& file) {
  require_fit(model, file);
  if (model.rotary() && model.value("stroke_m") != nullptr) {
    throw config::schema::bad_config(file + ": motion",
                                     "is rotary, but " + model.plant + " moves along a stroke",
                                     "linear, or another plant");
  }
  for (const formula::FormulaEffect& effect : model.formula_effects) {
    check_declared(model, effect, file);
  }
  check_priors(model, file);
  check_changes(model, file);
  const double* stroke_m = model.value("stroke_m");
  if (stroke_m != nullptr && *model.value("initial.y_m") > *stroke_m) {
    throw config::schema::bad_config(file + ": [initial] y_m", "is beyond the stroke",
                                     "0 to stroke_m");
  }
}

}  // namespace plant_sim
