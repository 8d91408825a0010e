// Checks of numbers on the command line. Those of CLI11 let NaN pass and print a range with three
// hundred digits.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class Validator;
}

namespace workbench::cli {

/// Above 0 and finite.
[[nodiscard]] CLI::Validator positive_number();
/// From `low` to `high`, both included.
[[nodiscard]] CLI::Validator number_within(double low, double high);
/// Neither NaN nor infinite.
[[nodiscard]] CLI::Validator finite_number();

}  // namespace workbench::cli
