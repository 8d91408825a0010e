// Stretches of long records, spread over their whole length: enough to search in, where simulating
// everything each time would take long.
#pragma once

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox {

/// Records longer than this together are searched in stretches.
inline constexpr double kLong_s = 240.0;
/// What the stretches come to together, about.
inline constexpr double kSearched_s = 60.0;
/// One of them: three blocks that are fitted and three that score (Split::blocks).
inline constexpr double kSegment_s = 6.0 * kBlock_s;

/// Length of all records together.
[[nodiscard]] double length_s(const FitDataset& data);

/// Each record in equal parts, of each part the stretch with the longest way of the rod; a record
/// shorter than two stretches stays whole. The stretches of a record are segments of it: the model
/// starts anew in each. Samples keep the weights that they have in `whole`, save those that have
/// not settled.
[[nodiscard]] FitDataset representative_segments(const FitDataset& whole);

}  // namespace estimator::greybox
