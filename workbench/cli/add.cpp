// spoolwatch add: a model file with one effect more, or with other values of one it has.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "config/record/whole_file.h"
#include "config/units/quantity.h"
#include "workbench/add/added_effect.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {
namespace {

struct AddOptions {
  std::string model, effect, output;
  std::vector<std::string> assignments;
};

void write_added(const AddOptions& options) {
  const add::AddedEffect added =
      add::add_effect(options.model, options.effect, options.assignments);
  const present::PrintedAxis axis(present::motion_of(added.model));
  config::record::write_whole(options.output, plant_sim::print_model(added.model));
  std::printf("%s: %s with %s\n", options.output.c_str(), added.model.name.c_str(),
              added.effect.name.c_str());
  for (const plant_sim::NamedValue& parameter : added.values.parameters) {
    const std::string unit = config::units::axis_unit(config::units::unit_of(parameter.name));
    std::printf("  %s = %s%s%s\n", parameter.name.c_str(),
                add::number_text(parameter.value).c_str(), unit.empty() ? "" : " ", unit.c_str());
  }
  if (added.neutral) {
    std::printf("  every value is neutral: no influence until one is given or fitted\n");
  }
}

}  // namespace

void add_add(CLI::App& command, int&) {
  auto options = std::make_shared<AddOptions>();
  add_model(command, options->model);
  command.add_option("EFFECT", options->effect, "its name, see `spoolwatch effects`")->required();
  command.add_option("key=value", options->assignments, "parameters; others stay as they are");
  command.add_option("-o,--output", options->output, "the model file to write")->required();
  command.callback([options] { write_added(*options); });
}

}  // namespace workbench::cli
