// Separation of two explanations: the distance of one from the motion that the other predicts, its
// parameters adjusted, relative to the noise floor or to a small share of the unexplained error
// where that is larger. 1 does not separate them.
#pragma once

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// RMS error [m] that `rival` leaves on the data, its parameters adjusted linearly against their
/// priors.
/// Takes about 20 ms for 30 s.
[[nodiscard]] double expected_separation(const SearchContext& context, const FitDataset& data,
                                         const FitSummary& rival);

/// The same with the rival fitted to convergence, held-out.
[[nodiscard]] double fitted_separation(const SearchContext& context, const FitDataset& data,
                                       const FitSummary& rival);

/// The same for the model that predicted the data, nothing adjusted: what its own beginning of the
/// motion, the steps of its simulation and rounding leave. Above 1, no model is told apart that
/// leaves less.
[[nodiscard]] double own_separation(const SearchContext& context, const FitDataset& data,
                                    const FitSummary& truth);

}  // namespace estimator::greybox::selection
