// Scatter of parameters between the halves of a record, which standard errors have to carry: where
// the model is not quite true, or its cost has many minima, each half has values of its own.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// Factor of each parameter's standard error: the distance of its two values over that which their
/// own errors let expect, where that is more than twice; otherwise 1. `weights`: samples of the
/// fit.
[[nodiscard]] Eigen::VectorXd split_scatter(const SearchContext& context, const FitSummary& fitted,
                                            const Eigen::VectorXd& weights, double observer_per_s);

}  // namespace estimator::greybox::selection
