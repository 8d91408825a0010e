// Parses a formula: muParser reads it with operators and functions that compute nothing but record
// what they are asked for, so that precedence and syntax are the library's and the result is a
// tape that runs on any kind of number.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/formula/tape.h"

namespace plant_sim {

/// `variables` (at most Tape::kVariables) and `parameters` are the names that the text may use,
/// besides pi. Throws config::schema::ConfigError at `where`, with position and token, when the
/// text is no single expression of these.
[[nodiscard]] Tape record_formula(const std::string& text,
                                  const std::vector<std::string>& variables,
                                  const std::vector<std::string>& parameters,
                                  const std::string& where);

/// Names that no parameter can have: functions and pi.
[[nodiscard]] const std::vector<std::string>& formula_words();

}  // namespace plant_sim
