// The memo of an innovation search keeps what was fitted beside its last stage without effects: the
// exchanges of the only effect found begin where the round began that found it.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {

/// A memo serves one search and its candidates. Copies share what they keep; calls from several
/// threads are safe but for `simulated`.
class TrialMemo {
 public:
  TrialMemo() = default;
  /// `known`: rounds of a search by simulations with the same candidates.
  explicit TrialMemo(const std::vector<Round>& known) : simulated(known) {}

  SimulatedEffectsMemo simulated;

  /// effect_trials(), kept for the last stage without effects.
  [[nodiscard]] std::vector<InnovationTrial> effects_beside(const InnovationStage& stage);

 private:
  /// A stage by its likelihood and its parameters.
  using StageKey = std::pair<double, std::vector<std::string>>;
  struct Kept {
    std::mutex mutex;
    StageKey stage;
    std::vector<InnovationTrial> trials;
  };
  [[nodiscard]] static StageKey key_of(const InnovationStage& stage);

  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

}  // namespace estimator::greybox::selection
