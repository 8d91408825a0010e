// How likely an effect's gain in a search is chance.
#pragma once

#include <cmath>
#include <string>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

struct Chance {
  double p_value = std::nan("");        ///< that what the effect gained is chance; NaN: not known
  double p_best_of_all = std::nan("");  ///< that the best of all that were tried gains as much
};

/// For what the effect gained when it was taken last.
[[nodiscard]] Chance chance_of(const StructureSearch& search, const std::string& effect);

}  // namespace estimator::greybox::selection
