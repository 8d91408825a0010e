// A comparison for the terminal: words, numbers, a bar chart of where the error arises.
#pragma once

#include <string>

#include "estimator/greybox/validation/comparison.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;

/// `unicode`: block characters, else ASCII. `all`: every variable's bins, not only the most
/// telling.
[[nodiscard]] std::string to_text(const validation::Comparison& comparison, bool unicode, bool all);

}  // namespace workbench::compare
