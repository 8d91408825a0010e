// spoolwatch add: a model file with one effect more, or with other values of one it has.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "config/units/quantity.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/present/printed_model.h"

namespace workbench::cli {
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

std::string shown(double value) {
  char buffer[32];
  return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), value).ptr};
}

double number_in(const std::string& assignment, const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, value);
  if (failed != std::errc() || rest != end) {
    throw config::schema::UsageError(assignment + ": is no assignment; allowed: parameter=number");
  }
  return value;
}

ModelFile::Effect& entry_of(ModelFile& model, const EffectInfo& effect) {
  for (ModelFile::Effect& entry : model.effects) {
    if (entry.name == effect.name) return entry;
  }
  throw bad_config(effect.name, "is not in the model's list");
}

void assign(ModelFile& model, const EffectInfo& effect, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals);
  const double value =
      number_in(assignment, equals == std::string::npos ? "" : assignment.substr(equals + 1));
  const ParameterInfo& info = parameter_named(effect, name);
  if (!(value >= info.min && value <= info.max)) {
    throw bad_config(effect.name + "." + name, "is " + shown(value) + ", out of range",
                     shown(info.min) + " to " + shown(info.max));
  }
  *model.value(effect.name + "." + name) = value;
}

struct AddOptions {
  std::string model, effect, output;
  std::vector<std::string> assignments;
};

void add(const AddOptions& options) {
  ModelFile model = present::load_printed_model(options.model);
  const EffectInfo effect = effect_named(model, options.effect);
  plant_sim::require_fit(effect, *plant_sim::find_plant(model.plant), options.model);
  entry_of(model, effect).present = true;
  std::set<std::string> given;
  for (const std::string& assignment : options.assignments) {
    const std::string name = assignment.substr(0, assignment.find('='));
    if (!given.insert(name).second) throw config::schema::UsageError(name + ": is given twice");
    assign(model, effect, assignment);
  }
  config::record::write_whole(options.output, plant_sim::print_model(model));

  std::printf("%s: %s with %s\n", options.output.c_str(), model.name.c_str(), effect.name.c_str());
  bool neutral = true;
  const ModelFile::Effect& entry = entry_of(model, effect);
  for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
    const double value = entry.parameters[i].value;
    const ParameterInfo& info = effect.parameters[i];
    neutral = neutral && value == info.neutral;
    std::printf("  %s = %s %s\n", info.name, shown(value).c_str(),
                config::units::unit_of(info.name).c_str());
  }
  if (neutral) std::printf("  every value is neutral: no influence until one is given or fitted\n");
}

}  // namespace

void add_add(CLI::App& command, int&) {
  auto options = std::make_shared<AddOptions>();
  add_model(command, options->model);
  command.add_option("EFFECT", options->effect, "its name, see `spoolwatch effects`")->required();
  command.add_option("key=value", options->assignments, "parameters; others stay as they are");
  command.add_option("-o,--output", options->output, "the model file to write")->required();
  command.callback([options] { add(*options); });
}

}  // namespace workbench::cli
