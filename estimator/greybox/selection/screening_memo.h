// A memo of how much effects and curves promise beside the stages that a diagnosis has reached. Its
// searches, each with other candidates, reach the same stages again.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Calls from several threads are safe. A result that is found has the bits of one computed anew:
/// whether it is kept never changes an answer. It keeps screened effects, gains of curves, and fits
/// of screened effects and of the models beside which they were screened.
class ScreeningMemo {
 public:
  /// Bytes of everything that screening an effect beside the stage depends on: records and gains by
  /// the residuals and the Jacobian that they lead to.
  [[nodiscard]] static std::string key_of(const SearchContext& context, const ModelStage& stage);
  /// Bytes of everything that a fit of the model to the training samples in a simulation depends
  /// on.
  [[nodiscard]] static std::string key_of_fit(const SearchContext& plain, const ModelStage& model);
  /// Bytes of the effect's definition in the model.
  [[nodiscard]] static std::string key_of(const SearchContext& context,
                                          const plant_sim::EffectInfo& effect);

  /// T: ScreeningResult, std::vector<CurveGain> or FitSummary.
  template <class T>
  [[nodiscard]] std::optional<T> find(const std::string& key);
  template <class T>
  void keep(const std::string& key, const T& result);

 private:
  /// Results under their keys; all are dropped when they take more than kMost_bytes.
  template <class T>
  struct Kept {
    std::map<std::string, T> results;
    std::size_t size_bytes = 0;
  };

  static constexpr std::size_t kMost_bytes = std::size_t{64} << 20U;
  std::mutex mutex_;
  std::tuple<Kept<ScreeningResult>, Kept<std::vector<CurveGain>>, Kept<FitSummary>> kept_;
};

/// The result that the context's memo has under the key, or `anew()`.
template <class T, class Anew>
T known_or(const SearchContext& context, const std::string& key, const Anew& anew) {
  if (!context.screenings) return anew();
  if (auto known = context.screenings->find<T>(key)) return *std::move(known);
  T result = anew();
  if (!context.cancelled()) context.screenings->keep(key, result);
  return result;
}

}  // namespace estimator::greybox::selection
