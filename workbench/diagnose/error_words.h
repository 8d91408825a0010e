// How far the error falls in a diagnosis, and towards which floor.
#pragma once

#include <string>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// Name of the error that no model of the command can beat.
[[nodiscard]] std::string floor_name(const selection::Diagnosis& d);

/// The held-out error before and after, and that of predictions by one sample.
[[nodiscard]] std::string fall_words(const selection::Diagnosis& d);

}  // namespace workbench::diagnose
