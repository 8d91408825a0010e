// Representative segments of long records, spread over their whole length, for a search that would
// take too long on all samples.
#pragma once

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox {

/// Total length above which the search uses segments.
inline constexpr double kLong_s = 240.0;
/// Approximate total length of the segments at kUsualRate_Hz and above. Slower logs are of slower
/// rigs, with fewer moves a minute: as many samples of these, but no more than twice as long.
inline constexpr double kSearched_s = 60.0;
inline constexpr double kUsualRate_Hz = 200.0;
inline constexpr double kMostOften = 2.0;
/// Length of a segment: three training and three validation blocks (Split::blocks).
inline constexpr double kSegment_s = 6.0 * kBlock_s;

/// Total length of all records.
[[nodiscard]] double length_s(const FitDataset& data);

/// Splits each record in equal parts and takes the segment with the longest travel from each part;
/// a record shorter than two segments stays whole. The simulation restarts in each segment. Samples
/// keep their masks of `whole`, except those that have not settled.
[[nodiscard]] FitDataset representative_segments(const FitDataset& whole);

}  // namespace estimator::greybox
