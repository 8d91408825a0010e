// Effects of a disturbed rig's model that can be left out, or exchanged for something else.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

/// Rivals within this of the best explain the record about as well.
inline constexpr double kRivals_nats = 8.0;

/// An effect found, and others that explain the record about as well in its place.
struct InnovationRivals {
  std::vector<std::string> names;
  std::vector<FitSummary> explanations;  ///< one for each name
};

/// Removes effects whose absence costs less than they are worth.
void eliminate(const SearchContext& plain, InnovationStage& stage, double evidence_nats);

/// For each effect found, those that explain the record about as well in its place. `before` is the
/// model as given.
[[nodiscard]] std::vector<InnovationRivals> rivals_of(const SearchContext& plain,
                                                      const InnovationStage& final,
                                                      const InnovationStage& before);

}  // namespace estimator::greybox::selection
