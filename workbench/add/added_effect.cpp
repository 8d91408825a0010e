#include "workbench/add/added_effect.h"

#include <charconv>
#include <set>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace workbench::add {
namespace {

using config::schema::bad_config;
using plant_sim::EffectInfo;
using plant_sim::ModelFile;
using plant_sim::ParameterInfo;

[[noreturn]] void refuse_name(const std::string& where, const std::string& typed,
                              const std::vector<std::string>& names) {
  const std::string near = config::schema::nearest(typed, names);
  throw bad_config(where, "is unknown" + (near.empty() ? "" : ", did you mean " + near + "?"),
                   config::schema::joined(names));
}

/// An effect of the library, or a formula that the model file declares.
EffectInfo effect_named(const ModelFile& model, const std::string& typed) {
  const std::string name = plant_sim::library_name(typed);
  std::vector<std::string> names;
  for (const EffectInfo& effect : plant_sim::effects_of(model)) {
    if (effect.name == name) return effect;
    names.push_back(effect.name);
  }
  for (const auto& [further, known] : plant_sim::further_names()) names.emplace_back(further);
  refuse_name("effect " + name, name, names);
}

const ParameterInfo& parameter_named(const EffectInfo& effect, const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : effect.parameters) {
    if (name == parameter.name) return parameter;
    names.emplace_back(parameter.name);
  }
  refuse_name(effect.name + "." + name, name, names);
}

void refuse_second_effect(const ModelFile& model, const std::string& assignment) {
  const std::string name = plant_sim::library_name(assignment);
  for (const EffectInfo& effect : plant_sim::effects_of(model)) {
    if (effect.name != name) continue;
    throw config::schema::UsageError(assignment +
                                     ": is a second effect; allowed: parameter=number, and one "
                                     "effect at a time, each to the file with those before");
  }
}

ModelFile::Effect& entry_of(ModelFile& model, const EffectInfo& effect) {
  for (ModelFile::Effect& entry : model.effects) {
    if (entry.name == effect.name) return entry;
  }
  throw bad_config(effect.name, "is not in the model's list");
}

void assign(ModelFile& model, const EffectInfo& effect, const std::string& assignment) {
  const auto [name, value] = parse_assignment(assignment);
  const ParameterInfo& info = parameter_named(effect, name);
  if (!(value >= info.min && value <= info.max)) {
    throw bad_config(effect.name + "." + name, "is " + number_text(value) + ", out of range",
                     number_text(info.min) + " to " + number_text(info.max));
  }
  *model.value(effect.name + "." + name) = value;
}

}  // namespace

std::string number_text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), value).ptr};
}

Assignment parse_assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
  double value = 0.0;
  const char* end = number.data() + number.size();
  const auto [rest, failed] = std::from_chars(number.data(), end, value);
  if (failed != std::errc() || rest != end) {
    throw config::schema::UsageError(
        text + (equals == std::string::npos ? ": lacks an equals sign" : ": has no number in it") +
        "; allowed: parameter=number, the number in the parameter's unit without the unit");
  }
  return {text.substr(0, equals), value};
}

AddedEffect add_effect(const std::string& file, const std::string& effect,
                       const std::vector<std::string>& assignments) {
  AddedEffect out;
  out.model = plant_sim::load_model(file);
  out.effect = effect_named(out.model, effect);
  plant_sim::require_fit(out.effect, *plant_sim::find_plant(out.model.plant), file);
  entry_of(out.model, out.effect).present = true;
  std::set<std::string> given;
  for (const std::string& assignment : assignments) {
    const std::string name = assignment.substr(0, assignment.find('='));
    refuse_second_effect(out.model, assignment);
    if (!given.insert(name).second) throw config::schema::UsageError(name + ": is given twice");
    assign(out.model, out.effect, assignment);
  }
  out.values = entry_of(out.model, out.effect);
  for (std::size_t i = 0; i < out.values.parameters.size(); ++i) {
    out.neutral = out.neutral && out.values.parameters[i].value == out.effect.parameters[i].neutral;
  }
  return out;
}

}  // namespace workbench::add
