// One round of the ladder: every absent effect on top of a stage, best first.
#pragma once

#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Of a quick fit.
inline constexpr int kQuickIterations = 8;

[[nodiscard]] Round single_round(const Workshop& shop, const Stage& stage, int number);
/// The most promising effects of a round two by two.
[[nodiscard]] std::vector<Candidate> pair_round(const Workshop& shop, const Round& singles);

/// Quick fits from every start of a glance; the best as a candidate of its effect.
[[nodiscard]] Candidate tried(const Workshop& shop, const Stage& stage, const Glance& glance,
                              int iterations = kQuickIterations);
/// The best candidates fitted to the end, with their Jacobians; all sorted, best first.
void finish(const Workshop& shop, const Stage& stage, std::vector<Candidate>& candidates);

[[nodiscard]] Stage with(const Stage& stage, const Candidate& candidate);
/// Probability that `later` scores better than `earlier` by chance.
[[nodiscard]] double chance(const Workshop& shop, const Fitted& earlier, const Fitted& later);

}  // namespace estimator::greybox::selection
