// One round of the search: every absent effect added to a stage, best first.
#pragma once

#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Iteration limit of a quick fit.
inline constexpr int kQuickIterations = 8;

[[nodiscard]] Round single_round(const SearchContext& context, const ModelStage& stage, int number);
/// The most promising effects of a round two by two.
[[nodiscard]] std::vector<Candidate> pair_round(const SearchContext& context, const Round& singles);

/// Quick fits from every start of a glance; the best as a candidate of its effect.
[[nodiscard]] Candidate quick_fit(const SearchContext& context, const ModelStage& stage,
                                  const ScreeningResult& screened,
                                  int iterations = kQuickIterations);
/// The best candidates fitted to the end, with their Jacobians; all sorted, best first.
void refine_best(const SearchContext& context, const ModelStage& stage,
                 std::vector<Candidate>& candidates);

[[nodiscard]] ModelStage with(const ModelStage& stage, const Candidate& candidate);
/// Probability that `later` scores better than `earlier` by chance.
[[nodiscard]] double chance(const SearchContext& context, const FitSummary& earlier,
                            const FitSummary& later);

}  // namespace estimator::greybox::selection
