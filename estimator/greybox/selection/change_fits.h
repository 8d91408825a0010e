// Fits of proposed changes: with the gains of the stage before, then with noise models of their
// own.
#pragma once

#include <vector>

#include "estimator/greybox/selection/change_proposals.h"

namespace estimator::greybox::selection {

/// A proposal fitted with the stage's gains, then with a noise model of its own.
[[nodiscard]] InnovationStage fitted(const ChangeProposal& proposal, const InnovationStage& stage,
                                     SimulationWidth width);

/// All proposals fitted, those that come near the best with noise models of their own.
[[nodiscard]] std::vector<InnovationStage> fit_all(const std::vector<ChangeProposal>& proposals,
                                                   const InnovationStage& stage, unsigned threads);

/// The stage settled with a change, its time scanned: with a noise model of its own the likelihood
/// shows it more clearly.
[[nodiscard]] InnovationStage polished(const ChangeProposal& taken, const InnovationStage& found,
                                       SimulationWidth width);

/// Standard error of the time at which a change begins, s, by the likelihood's profile, the other
/// parameters held: where nothing moves it is flat, and its curvature says nothing. 0 where the
/// time is not free, NaN where cancelled.
[[nodiscard]] double time_error_s(const InnovationStage& stage, const std::string& change);

}  // namespace estimator::greybox::selection
