// Scatter of parameters between the halves of a record, which standard errors have to carry: where
// the model is not quite true, or its cost has many minima, each half has values of its own.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// Half the distance of each theta's two values where that is more than twice what their own errors
/// let expect; otherwise 0, as where a parameter changes in time. `weights`: samples of the fit.
[[nodiscard]] Eigen::VectorXd split_scatter(const SearchContext& context, const FitSummary& fitted,
                                            const Eigen::VectorXd& weights, double observer_per_s);

}  // namespace estimator::greybox::selection
