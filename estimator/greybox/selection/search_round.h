// One round of the search: every absent effect added to a stage, best first.
#pragma once

#include <limits>
#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Iteration limit of a quick fit.
inline constexpr int kQuickIterations = 8;
/// Largest probability of chance of a gain, unless the gain is large.
inline constexpr double kChance = 0.01;
/// Probability of chance below which the held-out data tell two effects apart.
inline constexpr double kTold = 1e-3;

/// The round has no candidates where the linear estimate of none leaves less than `within_m`.
[[nodiscard]] Round single_round(const SearchContext& context, const ModelStage& stage, int number,
                                 double within_m = std::numeric_limits<double>::infinity());
/// Pairs of the most promising effects of a round.
[[nodiscard]] std::vector<Candidate> pair_round(const SearchContext& context, const Round& singles);

/// Quick fits from every start of a screening; the best as the effect's candidate.
[[nodiscard]] Candidate quick_fit(const SearchContext& context, const ModelStage& stage,
                                  const ScreeningResult& screened,
                                  int iterations = kQuickIterations);
/// Fits the best candidates to convergence with their Jacobians; sorts all, best first.
void refine_best(const SearchContext& context, const ModelStage& stage,
                 std::vector<Candidate>& candidates);

/// Fitted candidates first, by their held-out errors; the others by the linear estimate of theirs.
void sort_by_score(std::vector<Candidate>& candidates);

/// The candidate with the fewest parameters among those that explain the record as well as the
/// first, except one that moves the plant far from its expected values.
[[nodiscard]] const Candidate& simplest(const SearchContext& context,
                                        const std::vector<Candidate>& candidates);

[[nodiscard]] ModelStage with(const ModelStage& stage, const Candidate& candidate);
/// Probability that the lower error of `later` is chance.
[[nodiscard]] double chance(const SearchContext& context, const FitSummary& earlier,
                            const FitSummary& later);

}  // namespace estimator::greybox::selection
