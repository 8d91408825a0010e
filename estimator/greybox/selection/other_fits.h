// Fits of innovations from other starts than a stage's own: the likelihood has several maxima.
#pragma once

#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

struct OtherStart {
  ParameterSubset start;
  double least_fall = 0.0;  ///< least fall of -2 log L without further parameters
};

/// The likeliest of `fitted` and the fits from other starts. Each has a quick look, and is followed
/// where that is not far behind, nor on its way to the optimum of `fitted`. Threads change nothing.
[[nodiscard]] FitSummary likeliest_fit(const SearchContext& context, FitSummary fitted,
                                       const std::vector<OtherStart>& others, InnovationFit effort,
                                       SimulationWidth width);

/// True where the slopes of `fitted`, an optimum, expect the lag of `other` in -2 log L behind it:
/// then this is on its way there. False where they have other parameters, or differ in one that
/// moves nothing at the optimum.
[[nodiscard]] bool is_on_the_way(const FitSummary& fitted, const FitSummary& other, double lag,
                                 double floor_m);

}  // namespace estimator::greybox::selection
