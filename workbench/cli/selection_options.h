// Options with which a model's parameters and a record's samples are chosen for a fit.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "workbench/fit/parameter_selection.h"

namespace workbench::cli {

/// --free, --fix, --prior, --bounds, each repeatable.
inline void add_parameter_selection(CLI::App& command, fit::ParameterSelection& selection) {
  const auto each = [&](const char* name, std::vector<std::string>& values, const char* what) {
    command.add_option(name, values, what)->allow_extra_args(false);
  };
  each("--free", selection.free,
       "name[,name...]: fit these only; default: the plant's uncertain parameters and those of its "
       "effects");
  each("--fix", selection.fix, "name[,name...]: keep these values");
  each("--prior", selection.priors,
       "name=mean+-sd (sd in the unit, or in % of the mean), or name=none");
  each("--bounds", selection.bounds, "name=low:high");
}

/// --ignore, repeatable.
inline void add_ignored(CLI::App& command, std::vector<std::string>& spans) {
  command.add_option("--ignore", spans, "from:to or RECORD@from:to, s: ignore these samples")
      ->allow_extra_args(false);
}

}  // namespace workbench::cli
