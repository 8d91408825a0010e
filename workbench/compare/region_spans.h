// When a record is in a region in which the model fails.
#pragma once

#include <vector>

#include "estimator/greybox/validation/comparison.h"

namespace workbench::compare {

struct TimeSpan {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Stretches of the record within `region`, ascending; those closer than 0.1 s are one. At most
/// `most`, the longest.
[[nodiscard]] std::vector<TimeSpan> region_spans(
    const estimator::greybox::validation::Comparison& comparison,
    const estimator::greybox::validation::SignificantRegion& region, std::size_t most = 300);

}  // namespace workbench::compare
