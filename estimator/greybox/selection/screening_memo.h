// What effects promise beside the stages that a diagnosis has reached. Its searches, each with
// other candidates, reach the same stages again.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Calls from several threads are safe. What is found has the bits of what is computed anew:
/// whether it is kept never changes an answer.
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

  [[nodiscard]] std::optional<ScreeningResult> screened(const std::string& key);
  void keep(const std::string& key, const ScreeningResult& result);
  /// Gains of curves beside a stage, under its own key.
  [[nodiscard]] std::optional<std::vector<CurveGain>> curves(const std::string& key);
  void keep(const std::string& key, const std::vector<CurveGain>& gains);
  /// Fits of screened effects, and of the models beside which they were screened.
  [[nodiscard]] std::optional<FitSummary> fitted(const std::string& key);
  void keep(const std::string& key, const FitSummary& fit);

 private:
  /// Results under their keys; all are dropped when they take more than kMost_bytes.
  template <class T>
  struct Kept {
    std::map<std::string, T> results;
    std::size_t size_bytes = 0;
  };
  template <class T>
  std::optional<T> find(const Kept<T>& kept, const std::string& key);
  template <class T>
  void keep(Kept<T>& kept, const std::string& key, const T& result);

  static constexpr std::size_t kMost_bytes = std::size_t{64} << 20U;
  std::mutex mutex_;
  Kept<ScreeningResult> screened_;
  Kept<std::vector<CurveGain>> curves_;
  Kept<FitSummary> fitted_;
};

}  // namespace estimator::greybox::selection
