// A short stretch of the evidence, for looking at many things quickly.
#pragma once

#include "workbench/matching/evidence.h"
#include "workbench/matching/fitting.h"

namespace workbench::diagnose {

inline constexpr double kExcerpt_s = 8.0;

struct Excerpt {
  matching::Evidence evidence;  ///< all of it counts
  matching::Fitted fitted;      ///< the model fitted to the whole, its residual there
};

/// The stretch of the first record with the longest way, kExcerpt_s long or the whole record.
[[nodiscard]] Excerpt excerpt_of(const matching::Evidence& evidence,
                                 const matching::Fitted& fitted);

}  // namespace workbench::diagnose
