// The verdict of a diagnosis in one sentence.
#pragma once

#include <string>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

[[nodiscard]] std::string verdict_words(const selection::Diagnosis& diagnosis);

}  // namespace workbench::diagnose
