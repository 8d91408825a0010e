// The place where a remaining error enters the equations, in words.
#pragma once

#include <string>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// "The remaining error enters as a force that goes with the velocity v (99 % of its square)." with
/// the second place, where there is one; the variable and the sites in question where the record
/// does not tell these apart. Requires a place.
[[nodiscard]] std::string place_words(const selection::Diagnosis& diagnosis);

}  // namespace workbench::diagnose
