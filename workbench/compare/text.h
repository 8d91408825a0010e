// A comparison for the terminal: words, numbers, a bar chart of where the error arises.
#pragma once

#include <string>

#include "workbench/compare/comparison.h"

namespace workbench::compare {

/// `unicode`: block characters, else ASCII. `all`: every variable's bins, not only the most
/// telling.
[[nodiscard]] std::string to_text(const Comparison& comparison, bool unicode, bool all);

}  // namespace workbench::compare
