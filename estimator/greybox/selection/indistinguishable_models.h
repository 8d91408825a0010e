// Other effects that explain the record about as well as the found ones.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// One of the found effects, and the fits in which another effect replaces it.
struct IndistinguishableModels {
  std::string found;
  std::vector<std::string> others;       ///< best first
  std::vector<FitSummary> explanations;  ///< with `found`, then one per entry of `others`
};

/// Empty when no found effect has a rival. Effects that contain a found one as a special case (a
/// spring so long that it is a constant force) do not count as rivals.
[[nodiscard]] std::vector<IndistinguishableModels> find_indistinguishable(
    const SearchContext& context, const std::vector<Round>& rounds, const ModelStage& final);

}  // namespace estimator::greybox::selection
