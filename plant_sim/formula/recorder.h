// Parses a formula: muParser evaluates it with operators and functions that only record their
// operands, so that precedence and syntax are the library's and the result is a program that runs
// on any scalar type.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/formula/expression_program.h"

namespace plant_sim::formula {

/// `variables` (at most ExpressionProgram::kVariables, by their place; "" is none) and `parameters`
/// are the names that the text may use, besides pi. Throws config::schema::ConfigError at `where`,
/// with position and token, when the text is not a single expression of these.
[[nodiscard]] ExpressionProgram record_formula(const std::string& text,
                                               const std::vector<std::string>& variables,
                                               const std::vector<std::string>& parameters,
                                               const std::string& where);

/// Names that no parameter can have: functions and pi.
[[nodiscard]] const std::vector<std::string>& formula_words();

}  // namespace plant_sim::formula
