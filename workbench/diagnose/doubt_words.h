// Why effects count as no more than possible, in sentences.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// "Not established: backlash (its size is within its error)." and what may be so in its place; for
/// a diagnosis with possible effects.
[[nodiscard]] std::vector<std::string> doubt_words(const selection::Diagnosis& d);

}  // namespace workbench::diagnose
