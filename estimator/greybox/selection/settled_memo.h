// Stages that a diagnosis has settled. Its searches, with other candidates and other limits, reach
// the same stages again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/packed_linearisation.h"

namespace estimator::greybox::selection {

/// Calls from several threads are safe. A stage that is found has the bits of one settled anew.
class SettledMemo {
 public:
  /// Bytes of everything that settled() depends on: records, model with the effects in use,
  /// parameters, noise model, effort and the width of its simulations. `plain`: data without
  /// innovations.
  [[nodiscard]] static std::string key_of(const SearchContext& plain, const ModelStage& model,
                                          const disturbance::NoiseModel& start, Settling effort,
                                          SimulationWidth width);

  /// The stage kept under the key, in the context of `plain`.
  [[nodiscard]] std::optional<InnovationStage> find(const SearchContext& plain,
                                                    const std::string& key);
  /// Keeps what settled() found in the context of `plain`. Drops the stages that were not asked for
  /// the longest while all take more than `most_bytes`.
  void keep(const SearchContext& plain, const std::string& key, const InnovationStage& stage);

  /// The least -2 log L, with its penalty, that a model for the records of `plain` has been kept
  /// with: one without spectral lines, of effects in their range, too few to stand in for a law.
  /// Infinite: none.
  [[nodiscard]] double least_minus_two_log(const SearchContext& plain);

  [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }

  static constexpr std::size_t kMost_bytes = std::size_t{256} << 20U;
  explicit SettledMemo(std::size_t most_bytes = kMost_bytes) : most_bytes_(most_bytes) {}

 private:
  /// A stage without context and linearisations.
  struct Kept {
    InnovationStage stage;
    std::vector<PackedLinearisation> linear;
    std::vector<std::shared_ptr<const InnovationGains>> gains;
    std::size_t size_bytes = 0;
  };
  struct Entry {
    std::shared_ptr<const Kept> kept;
    std::list<const std::string*>::iterator use;
  };

  /// The stage kept under a key, the latest asked for from now on; null for none.
  std::shared_ptr<const Kept> use(const std::string& key);

  std::size_t most_bytes_;
  std::mutex mutex_;
  std::map<std::string, Entry> stages_;
  std::list<const std::string*> by_use_;  ///< keys of `stages_`, the latest asked for last
  std::size_t size_bytes_ = 0;
  std::map<std::uint64_t, double> least_;  ///< by the records' hash
};

}  // namespace estimator::greybox::selection
