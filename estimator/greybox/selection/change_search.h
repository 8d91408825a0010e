// The parameters that change within a record, where no effect explains it: those that a score test
// proposes (change_scores.h), simulated, fitted and judged by the likelihood of innovations.
#pragma once

#include <optional>
#include <vector>

#include "estimator/greybox/selection/change_proposals.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/parameter_change.h"

namespace estimator::greybox::selection {

/// True where a curve over the motion promises more than any change in time.
[[nodiscard]] bool motion_explains_more(const InnovationStage& stage);
/// Gain that the most promising change in time promises beside the stage, or a load that sets in.
[[nodiscard]] double change_nats(const InnovationStage& stage);

struct ChangeSearch {
  SearchContext context;  ///< the problem with the changes in its model
  InnovationSearch innovations;
  std::vector<ParameterChange> changes;
};

/// Where a curve over the motion promises more than any change, what is missing may be a law, which
/// a change follows at best: there changes are sought after laws, elsewhere before them.
enum class ChangesSought { before_laws, after_laws };

struct FoundChanges {
  std::optional<ChangeSearch> explaining;  ///< one or two that leave no physics unexplained
  std::optional<ChangeSearch> likeliest;   ///< the likeliest alone, whatever it leaves
};

/// Empty where changes are sought at the other time, unless some are known: `starts`, fitted by
/// simulations. `base`: a fitted model, with effects or without.
[[nodiscard]] FoundChanges search_changes(const SearchContext& context, const ModelStage& base,
                                          ChangesSought sought = ChangesSought::before_laws,
                                          const std::vector<ChangeProposal>& starts = {});

}  // namespace estimator::greybox::selection
