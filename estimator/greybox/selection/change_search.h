// The parameters that change within a record, where no effect explains it: those that a score test
// proposes (change_scores.h), simulated, fitted and judged by the likelihood of innovations.
#pragma once

#include <optional>
#include <vector>

#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/parameter_change.h"

namespace estimator::greybox::selection {

struct ChangeSearch {
  SearchContext context;  ///< the problem with the changes in its model
  InnovationSearch innovations;
  std::vector<ParameterChange> changes;
};

/// Whether a change is sought where a curve over the motion promises more than any: then what is
/// missing may be a law, which a change follows at best.
enum class Against { motion, nothing };

/// None where one or two changes leave physics unexplained. `base`: a fitted model, with effects
/// or without.
[[nodiscard]] std::optional<ChangeSearch> search_changes(const SearchContext& context,
                                                         const ModelStage& base,
                                                         Against against = Against::motion);

}  // namespace estimator::greybox::selection
