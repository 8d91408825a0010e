// Candidates of a round of the innovation search before they get noise models of their own.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "estimator/greybox/disturbance/spectral_lines.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

inline constexpr double kEvidence_nats = 15.0;
inline constexpr double kPerParameter_nats = 4.3;  ///< log(6000) / 2: a record of 30 s
inline constexpr double kParametersOfLine = 3.0;

/// A candidate of a round: an effect, or a spectral line where `effect` is empty.
struct InnovationCandidate {
  std::string effect;
  std::vector<std::string> taken_with_it;  ///< further effects of a model that is taken whole
  disturbance::SpectralLine line;
  double gain_nats = 0.0;  ///< less its penalty
  double penalty_nats = 0.0;
  bool settled = false;  ///< with a noise model of its own
  FitSummary fitted;     ///< settled: parameters and their values, without Jacobian
};

struct InnovationTrial {
  InnovationCandidate candidate;
  std::vector<ModelStage> starts;  ///< fitted with the stage's gains, with the weak observer
  double penalty_nats = 0.0;
  bool simulated = false;  ///< promising in a simulation with the weak observer
  /// Groups of further starts, of each the one that is likeliest with a predictor of its own: the
  /// stage's gains take a resonance for a force.
  std::vector<std::vector<ParameterSubset>> elsewhere;
};

/// The noise model with a line at another site; what its waves were there is forgotten.
[[nodiscard]] disturbance::NoiseModel moved(disturbance::NoiseModel noise, std::size_t line,
                                            disturbance::LineSite site);

/// The stage's noise model with its random force on the other of two masses.
[[nodiscard]] disturbance::NoiseModel with_force_on_other_mass(const InnovationStage& stage);

[[nodiscard]] double penalty_nats(const FitSummary& with, const FitSummary& without);
/// -2 log L with a penalty for each parameter.
[[nodiscard]] double penalised(const InnovationStage& stage);

/// The effects by what they promise with the stage's gains, the most promising first.
[[nodiscard]] std::vector<ScreeningResult> screened_effects(const InnovationStage& stage);
/// Gain that a screened effect promises beside the stage.
[[nodiscard]] double expected_nats(const InnovationStage& stage, const ScreeningResult& screened);

/// Gain that the most promising effect promises; 0: none.
[[nodiscard]] double promised_nats(const InnovationStage& stage);

/// The most promising effects, fitted with the stage's gains.
[[nodiscard]] std::vector<InnovationTrial> effect_trials(const InnovationStage& stage);

/// An effect added to a model, fitted in a simulation with the weak observer.
struct SimulatedEffect {
  std::string effect;
  FitSummary fitted;
};
struct SimulatedEffects {
  double training_rms_without_m = 0.0;
  std::vector<SimulatedEffect> effects;
};

/// The names of the model's parameters, sorted: that of an effect does not tell its refinements.
[[nodiscard]] std::vector<std::string> parameters_of(const ModelStage& model);

/// The effects that simulations show beside a model's, found once for each set of effects.
class SimulatedEffectsMemo {
 public:
  SimulatedEffectsMemo() = default;
  /// `known`: rounds of a search by simulations with the same candidates.
  explicit SimulatedEffectsMemo(const std::vector<Round>& known);
  const SimulatedEffects& beside(const SearchContext& plain, const ModelStage& model);
  [[nodiscard]] bool knows(const ModelStage& model) const;
  [[nodiscard]] bool empty() const { return known_.empty(); }

 private:
  std::map<std::vector<std::string>, SimulatedEffects> known_;
};

/// Further starts for the most promising of them: the stage's gains may be those that hide an
/// effect, above all friction that sticks.
void add_simulated_starts(const InnovationStage& stage, SimulatedEffects simulated,
                          std::vector<InnovationTrial>& trials);
void sort_by_gain(std::vector<InnovationTrial>& trials);

}  // namespace estimator::greybox::selection
