// One round of the innovation search: effects and spectral lines compete, and the likeliest is
// taken.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "estimator/greybox/selection/trial_memo.h"

namespace estimator::greybox::selection {

struct InnovationRound {
  ModelStage before;                            ///< without Jacobian
  std::vector<InnovationCandidate> candidates;  ///< the one taken, if any, then the best first
  bool taken = false;                           ///< the first candidate
};

enum class Candidates { effects_and_lines, lines };

struct RoundOptions {
  Candidates candidates = Candidates::effects_and_lines;
  std::size_t most_effects = 0;
  double evidence_nats = kEvidence_nats;  ///< a candidate must gain as much
};

/// Takes the likeliest candidate into the stage; false when nothing gains enough. `dropped`:
/// effects that are no candidates any more, with those that the candidate drives out of their
/// range.
bool extend(const SearchContext& plain, InnovationStage& stage, const RoundOptions& options,
            TrialMemo& memo, std::vector<InnovationRound>& rounds, std::set<std::string>& dropped);

/// The stage with a spectral line at each of the other sites in turn.
[[nodiscard]] std::vector<InnovationStage> at_other_sites(const SearchContext& plain,
                                                          const InnovationStage& stage,
                                                          std::size_t line);

/// Moves each spectral line to the site where the model makes it likeliest: where it enters is
/// decided before the effects are known that pass it on.
void reconsider_sites(const SearchContext& plain, InnovationStage& stage);

/// The first effect of the stage that has left its range, or rings with a line; empty: none.
[[nodiscard]] std::string effect_out_of_range(const InnovationStage& stage);

}  // namespace estimator::greybox::selection
