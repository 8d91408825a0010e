// A short stretch of the evidence, for looking at many things quickly.
#pragma once

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

inline constexpr double kExcerpt_s = 8.0;

struct Excerpt {
  Evidence evidence;  ///< all of it counts
  Fitted fitted;      ///< the model fitted to the whole, its residual there
};

/// The stretch of the first record with the longest way, kExcerpt_s long or the whole record.
[[nodiscard]] Excerpt excerpt_of(const Evidence& evidence, const Fitted& fitted);

}  // namespace estimator::greybox::selection
