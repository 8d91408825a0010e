// Parameters that change within a record, in words.
#pragma once

#include <string>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// "damping_N_s_per_m goes from 1000 N s/m to 1800 +- 20 N s/m at 12.00 s".
[[nodiscard]] std::string change_words(const selection::ParameterChange& change);

/// SelectionStep::added for readers: "damping_N_s_per_m that changes", "mass_kg of b.csv"; effects
/// as they are.
[[nodiscard]] std::string step_name(const std::string& added);

/// The verdict `changing`, in a sentence for the changes and one for each that has rivals.
[[nodiscard]] std::string changing_words(const selection::Diagnosis& diagnosis);

}  // namespace workbench::diagnose
