// Stages that a diagnosis has settled. Its searches, with other candidates and other limits, come
// by the same stages again.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

/// Calls from several threads are safe. A stage that is found again has the bits of one settled
/// anew: what is kept never changes an answer.
class SettledMemo {
 public:
  /// What a stage settled from there follows from: the record, the model with the effects in use,
  /// the parameters, the noise model and the number of turns.
  [[nodiscard]] static std::string key_of(const SearchContext& plain, const ModelStage& model,
                                          const disturbance::NoiseModel& start, int turns);

  /// The stage kept under the key, in the context of `plain`.
  [[nodiscard]] std::optional<InnovationStage> find(const SearchContext& plain,
                                                    const std::string& key) const;
  /// The oldest stages make room where all take more than kMost_bytes.
  void keep(std::string key, const InnovationStage& stage);

  static constexpr std::size_t kMost_bytes = std::size_t{256} << 20U;

 private:
  /// A stage whose context holds the gains alone.
  struct Kept {
    InnovationStage stage;
    std::vector<std::shared_ptr<const InnovationGains>> gains;
    std::size_t size_bytes = 0;
  };

  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const Kept>> stages_;
  std::deque<std::string> by_age_;
  std::size_t size_bytes_ = 0;
};

}  // namespace estimator::greybox::selection
