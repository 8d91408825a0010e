// How far one explanation stays from the motion that another one gives, when its parameters may
// adjust: over the noise floor, or over a small part of what that one leaves unexplained where this
// is more, so that 1 is nothing to go by.
#pragma once

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// RMS error [m] that `rival` leaves on the data, its parameters adjusted linearly against their
/// priors.
/// Takes about 20 ms for 30 s.
[[nodiscard]] double expected_separation(const SearchContext& context, const FitDataset& data,
                                         const FitSummary& rival);

/// The same with the rival fitted for good, held out.
[[nodiscard]] double fitted_separation(const SearchContext& context, const FitDataset& data,
                                       const FitSummary& rival);

}  // namespace estimator::greybox::selection
