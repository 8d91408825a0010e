// Stretches of long records, spread over their whole length: enough to search in, where simulating
// everything each time would take long.
#pragma once

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox {

/// Records longer than this together are searched in stretches.
inline constexpr double kLong_s = 240.0;
/// Approximate total length of the segments.
inline constexpr double kSearched_s = 60.0;
/// One of them: three blocks that are fitted and three that score (Split::blocks).
inline constexpr double kSegment_s = 6.0 * kBlock_s;

/// Length of all records together.
[[nodiscard]] double length_s(const FitDataset& data);

/// Splits each record in equal parts and takes the segment with the longest travel from each part;
/// a
/// record shorter than two segments stays whole. The simulation restarts in each segment. Samples
/// keep
/// their masks of `whole`, except those that have not settled.
[[nodiscard]] FitDataset representative_segments(const FitDataset& whole);

}  // namespace estimator::greybox
