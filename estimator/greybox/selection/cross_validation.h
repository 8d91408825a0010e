// Cross-validation of an addition where the remaining error exceeds the noise.
//
// Held-out blocks between fitted ones share the remaining systematic error, which an addition can
// follow in both. An addition therefore has to lower the error of either half of the records when
// fitted to the other; where noise does not explain the rest, in the free run without observer.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// The data of a search in halves, with the errors of models fitted to either so far: the same
/// model stands for comparison many times.
class CrossValidation {
 public:
  explicit CrossValidation(const SearchContext& context);

  /// True when `more`, which has the parameters of `plain` and further ones, has the smaller error
  /// on both halves. `explained`: score with the observer.
  [[nodiscard]] bool holds(bool explained, const ParameterSubset& plain,
                           const ParameterSubset& more);

 private:
  /// Names of the parameters, their start and whether the observer runs.
  using Key = std::pair<std::vector<std::string>, std::vector<double>>;
  /// Held-out errors in m, fitted to the first and to the second half.
  using Errors = std::pair<double, double>;

  [[nodiscard]] static Key key_of(bool explained, const ParameterSubset& model);
  void fit_missing(bool explained, const std::vector<const ParameterSubset*>& models);

  const SearchContext& context_;
  FitDataset forth_, back_;
  std::map<Key, Errors> known_;
};

/// Error of the samples that are fitted, from kBlock_s after each record's start on, where what the
/// rig began with has settled: an event between samples that score is seen there alone. Where whole
/// records are held out, these judge: their error. 0 of records that are no longer.
[[nodiscard]] double fitted_rms_m(const FitDataset& data, const FitSummary& fitted);

/// The larger one of the held-out error and fitted_rms_m().
[[nodiscard]] double whole_rms_m(const SearchContext& context, const FitSummary& fitted);

/// True when noise explains the stage's held-out error, and roughly that of fitted_rms_m().
[[nodiscard]] bool is_explained(const SearchContext& context, const ModelStage& stage);

}  // namespace estimator::greybox::selection
