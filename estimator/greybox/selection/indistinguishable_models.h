// Which other effects explain the record about as well as those that were found.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// One of the found effects, and the fits in which another effect stands in its place.
struct Rivalry {
  std::string found;
  std::vector<std::string> others;   ///< best first
  std::vector<Fitted> explanations;  ///< with `found`, then one for each of the others
};

/// Empty when every found effect stands alone. Effects that contain a found one as a special case
/// (a spring so long that it is a constant force) are no rivals.
[[nodiscard]] std::vector<Rivalry> rivalries(const Workshop& shop, const std::vector<Round>& rounds,
                                             const Stage& final);

}  // namespace estimator::greybox::selection
