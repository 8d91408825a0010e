// Model files with a formula effect, for the tests of formulas.
#pragma once

#include <string>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "plant_sim/model_file.h"

namespace plant_sim::testing {

inline std::string plant_text(const std::string& plant) {
  return "schema_version = 1\nname = \"test\"\nplant = \"" + plant + "\"\n";
}

/// An effect "own" with parameter k, min to max, typically half of max.
inline std::string own_text(const std::string& site, const std::string& formula,
                            const std::string& min = "0.0", const std::string& max = "1e6") {
  return "[formula_effects.own]\nsite = \"" + site + "\"\nformula = '" + formula +
         "'\n[formula_effects.own.parameters.k]\nmin = " + min + "\nmax = " + max +
         "\ntypical = " + std::to_string(0.5 * std::stod(max)) + "\n";
}

/// A further parameter of "own".
inline std::string parameter_text(const std::string& name, const std::string& min,
                                  const std::string& max, const std::string& typical,
                                  const std::string& neutral) {
  return "[formula_effects.own.parameters." + name + "]\nmin = " + min + "\nmax = " + max +
         "\ntypical = " + typical + "\nneutral = " + neutral + "\n";
}

inline ModelFile model_of(const std::string& text) {
  return read_model(config::schema::Document::parse(text, "own.toml"));
}

/// The line that refuses the text; "" when it is accepted.
inline std::string refusal_of(const std::string& text) {
  try {
    (void)model_of(text);
  } catch (const config::schema::ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace plant_sim::testing
