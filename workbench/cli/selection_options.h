// Options with which a model's parameters and a record's samples are chosen for a fit.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config/schema/error.h"
#include "estimator/greybox/fit_dataset.h"
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

/// --fit, with "all" for commands that may fit everything.
inline CLI::Option* add_split(CLI::App& command, std::string& fit, bool all = false) {
  const std::string also = all ? "all" : "";
  const auto refuse = [also](const std::string& text) {
    try {
      if (text.empty() || text != also) (void)estimator::greybox::parse_split(text);
      return std::string();
    } catch (const config::schema::UsageError&) {
      return "is " + text + "; allowed: " + (also.empty() ? "" : also + ", ") +
             estimator::greybox::kSplits;
    }
  };
  return command
      .add_option("--fit", fit,
                  "part of each record that is fitted; the rest validates. blocks:40 fits every "
                  "other 40 s, each begun anew")
      ->check(CLI::Validator(refuse, std::string("{") + (all ? "all," : "") +
                                         "blocks,blocks:SECONDS,first-half,second-half}"))
      ->capture_default_str();
}

}  // namespace workbench::cli
