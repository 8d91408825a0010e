// spoolwatch add: a model file with one effect more, or with other values of one it has; the effect
// may be a formula that is typed or that a diagnosis has learned.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/add/added_effect.h"
#include "workbench/add/own_formula.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/shell_command.h"

namespace workbench::cli {
namespace {

struct AddOptions {
  std::string model, effect, output;
  std::vector<std::string> assignments;
  std::string formula, memory, name, diagnosis;
  int law = 0;
};

add::AddedEffect added_by(const AddOptions& options) {
  const bool own = !options.formula.empty() || options.law != 0;
  if (!own && options.effect.empty()) {
    throw config::schema::UsageError(
        "add: has nothing to add; allowed: EFFECT, --formula or --law with --from");
  }
  if (!own && !options.name.empty()) {
    throw config::schema::UsageError("--name: names a formula; allowed: with --formula or --law");
  }
  if (!own) return add::add_effect(options.model, options.effect, options.assignments);
  std::vector<std::string> assignments = options.assignments;
  // no EFFECT there: the first word is an assignment too
  if (!options.effect.empty()) assignments.insert(assignments.begin(), options.effect);
  return options.law != 0 ? add::add_law(options.model, options.diagnosis, options.law,
                                         options.name, assignments)
                          : add::add_formula(options.model, options.formula, options.memory,
                                             options.name, assignments);
}

void write_added(const AddOptions& options) {
  const add::AddedEffect added = added_by(options);
  const present::PrintedAxis axis(present::motion_of(added.model));
  config::record::write_whole(options.output, plant_sim::print_model(added.model));
  std::vector<std::string> before;
  for (const plant_sim::ModelFile::Effect& effect : added.model.effects) {
    if (effect.present && effect.name != added.effect.name) before.push_back(effect.name);
  }
  const std::string beside = before.empty() ? "" : ", beside " + config::schema::joined(before);
  std::printf("%s: %s with %s%s\n", options.output.c_str(), added.model.name.c_str(),
              added.effect.name.c_str(), beside.c_str());
  for (const plant_sim::NamedValue& parameter : added.values.parameters) {
    const std::string unit = config::units::axis_unit(config::units::unit_of(parameter.name));
    std::printf("  %s = %s%s%s\n", parameter.name.c_str(),
                add::number_text(parameter.value).c_str(), unit.empty() ? "" : " ", unit.c_str());
  }
  if (added.neutral) {
    std::printf("  every value is neutral: no influence until one is given or fitted\n");
  }
  if (options.law != 0) {
    const std::string written = present::shell_word(options.output);
    std::printf(
        "  the other values are those of %s, beside which the law was not fitted; next:\n"
        "  spoolwatch fit %s RECORD -o %s\n",
        options.model.c_str(), written.c_str(), written.c_str());
  }
}

}  // namespace

void add_add(CLI::App& command, int&) {
  auto options = std::make_shared<AddOptions>();
  add_model(command, options->model);
  command.add_option("EFFECT", options->effect,
                     "its name, see `spoolwatch effects`; none with --formula or --law");
  command.add_option("key=value", options->assignments, "parameters; others stay as they are");
  CLI::Option* const formula = command.add_option(
      "--formula", options->formula,
      "SITE: EXPRESSION, a formula of one's own with its parameters: \"force: c*v_mps^3\" c=1e5");
  command
      .add_option("--memory", options->memory,
                  "rate of change of a memory z that the formula reads: \"(u_V - z)/lag_s\"")
      ->needs(formula);
  CLI::Option* const law =
      command.add_option("--law", options->law, "the N-th law of a diagnosis, from 1")
          ->excludes(formula);
  CLI::Option* const from =
      command.add_option("--from", options->diagnosis, "what `diagnose --json` has written")
          ->needs(law);
  law->needs(from);
  command.add_option("--name", options->name,
                     "name of the formula's block (own_SITE, or the law's name)");
  command.add_option("-o,--output", options->output, "the model file to write")->required();
  command.callback([options] { write_added(*options); });
}

}  // namespace workbench::cli
