// The search for missing effects on a rig whose process is disturbed: by forces, a pulsating
// supply, a shaking sensor mount.
//
// A simulation's error is then the disturbance's, slow and large, and hides what is missing. Here a
// model is judged by its innovations (disturbance/): with the noise model that fits it best, they
// are white, and a likelihood counts what each candidate explains.
//
//   gain of a candidate = log L(with it) - log L(stage), each with its own noise model, in nats
//
// Effects of the library and spectral lines compete in one ladder; a candidate must gain kEvidence
// more than kPerParameter for each of its parameters. Fits use every sample: white innovations make
// that valid. An effect chosen while others and lines were not known is held against the other
// effects again at the end, and exchanged where one is likelier; three or more that leave physics
// unexplained stand in for a law and are not. Source for the penalty: G.
// Schwarz, Annals of Statistics 6 (1978) 461.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "estimator/greybox/disturbance/force_jump.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_rivals.h"
#include "estimator/greybox/selection/innovation_round.h"
#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {

inline constexpr std::size_t kMostInnovationEffects = 4;

/// Gain of a load that sets in, over that of jumps that are usual on the record.
inline constexpr double kStandsOut = 3.0;

struct InnovationSearch {
  InnovationStage before;  ///< the model as given and its noise model, lines not included
  InnovationStage final;
  std::vector<InnovationRound> rounds;
  std::vector<InnovationStage> without;  ///< `final` without each of its effects, where known
  /// For each effect, those that explain the record about as well in its place; empty: not known.
  std::map<std::string, InnovationRivals> rivals;
  /// Nats that the absence of each effect would cost; where not known, its gain when it was added.
  std::map<std::string, double> gains_nats;
  /// Effects that gain by how the rig answers what disturbs it, and hardly by the motion.
  std::set<std::string> undriven;
  double curve_nats = 0.0;    ///< largest gain of a curve over a variable of the motion
  double inexact_nats = 0.0;  ///< gains that inexact models of what was explained may owe

  bool ended_early = false;  ///< by SearchLimits::ends_at

  /// The likeliest load that sets in at one sample.
  disturbance::ForceJump jump;

  TrialMemo memo;        ///< kept from round to round
  InnovationStage bare;  ///< the last stage without effects

  /// True when a load sets in, which no curve over the motion explains better and which stands out
  /// from the disturbance's own jumps.
  [[nodiscard]] bool load_sets_in() const {
    return jump.gain_nats > std::max(curve_nats, kCurve_nats + inexact_nats) &&
           jump.gain_nats > kStandsOut * jump.usual_nats;
  }
  [[nodiscard]] bool physics_missing() const {
    return load_sets_in() || curve_nats > kCurve_nats + inexact_nats;
  }
};

/// Where a search ends before nothing more is found.
struct SearchLimits {
  std::size_t most_effects = kMostInnovationEffects;
  /// Asked at each stage that a round has reached, with the gains that inexact models may owe: true
  /// ends the search there. Empty: never.
  std::function<bool(const InnovationStage&, double inexact_nats)> ends_at;
};

/// True where `found` is likelier, by kRivals_nats, than `stage`, than `held`, the best model of a
/// search by simulations, and, where `stage` has no effects, than it with the two most promising of
/// them. `held` and these get noise models of their own, and the spectral lines of `found`.
[[nodiscard]] bool is_clearly_likelier(const SearchContext& context, const InnovationStage& found,
                                       const InnovationStage& stage, const ModelStage& held);

/// True where `held`, the best model of a search by simulations, leaves no physics: settled once
/// with the noise model of `before`, the model as given, it is likelier than this, and no curve
/// over the motion explains more of the rest than inexact models may owe.
[[nodiscard]] bool explains_record(const SearchContext& context, const InnovationStage& before,
                                   const ModelStage& held);

/// `first` is the model as given, fitted with the weak observer, `held` another search's rounds and
/// the best that it has found: this is taken where its likelihood is the higher one. Records that
/// only score take no part.
[[nodiscard]] InnovationSearch search_innovations(const SearchContext& context,
                                                  const ModelStage& first, const SearchBranch& held,
                                                  const SearchLimits& limits = {});

/// The context without records that only score.
[[nodiscard]] SearchContext without_holdouts(SearchContext context);

/// Adds spectral lines to the stage that a search has reached; its effects stay. Sets the search's
/// rounds and inexact_nats; `search.before` is the stage from which gains count.
void add_lines(const SearchContext& context, InnovationSearch& search, InnovationStage& stage);

/// The likeliest load that sets in at one sample.
[[nodiscard]] disturbance::ForceJump likeliest_jump(const InnovationStage& stage);

/// Sets what the final model leaves: the gain of curves over the motion, and the likeliest jump.
void weigh_remainder(const SearchContext& context, InnovationSearch& search);

/// exchanges() of the i-th effect of the final model with the candidates of `context`.
[[nodiscard]] std::vector<InnovationStage> exchanges_of(const SearchContext& context,
                                                        const InnovationSearch& search,
                                                        std::size_t i, TrialMemo& memo);

/// For each of `effects`, those that explain the record about as well in its place.
[[nodiscard]] std::vector<InnovationRivals> find_rivals(const SearchContext& context,
                                                        const InnovationSearch& search,
                                                        const std::vector<std::string>& effects);

}  // namespace estimator::greybox::selection
