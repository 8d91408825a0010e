// Effects of a disturbed rig's model that can be left out, or exchanged for something else.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_round.h"
#include "estimator/greybox/selection/trial_memo.h"

namespace estimator::greybox::selection {

/// Rivals within this of the best explain the record about as well.
inline constexpr double kRivals_nats = 8.0;
/// Lag within which a rival with a noise model of its own is polished before it is dismissed.
inline constexpr double kWorthPolishing_nats = 30.0;

/// An effect found, and others that explain the record about as well in its place.
struct InnovationRivals {
  std::vector<std::string> names;
  std::vector<FitSummary> explanations;  ///< one for each name
};

/// The stage without an effect, settled anew.
[[nodiscard]] InnovationStage without(const SearchContext& plain, const InnovationStage& stage,
                                      const std::string& effect);

/// The stage, or where it is less likely than the model `bare` without effects, which it contains,
/// the likelier of it and its fits from there.
[[nodiscard]] InnovationStage not_above(const SearchContext& plain, InnovationStage stage,
                                        const InnovationStage& bare);

/// Removes effects whose absence costs less than they are worth. Returns the stage without each of
/// those that stay; without the only one it is not known. `bare`: the model without effects.
std::vector<InnovationStage> eliminate(const SearchContext& plain, InnovationStage& stage,
                                       const InnovationStage& bare, double evidence_nats);

/// The final stage with other effects in the place of one, the most promising first, the other
/// effect the last of `added`; each settled, and polished where it may be level. Effects that leave
/// their range are none. `without` is the final stage without the effect.
[[nodiscard]] std::vector<InnovationStage> exchanges(const SearchContext& plain,
                                                     const InnovationStage& final,
                                                     const std::string& effect,
                                                     const InnovationStage& without,
                                                     TrialMemo& memo);

/// Adds to `exchanges` the final stage with the runners-up of the round that took an effect in the
/// place of that one: the lines and effects that came in since may be their own. Settled, and
/// polished where one may be level; effects that leave their range are none.
void add_runners_up(const SearchContext& plain, const InnovationStage& final,
                    const std::string& effect, const std::vector<InnovationRound>& rounds,
                    std::vector<InnovationStage>& exchanges);

/// The effect and those of its exchanges that explain the record about as well, where the search
/// may owe `inexact_nats` to models that are not exact.
[[nodiscard]] InnovationRivals rivals_among(const InnovationStage& final, const std::string& effect,
                                            const std::vector<InnovationStage>& exchanges,
                                            double inexact_nats);

}  // namespace estimator::greybox::selection
