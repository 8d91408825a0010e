// Short segment of the data for screening.
#pragma once

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

inline constexpr double kScreeningSegment_s = 8.0;

struct ScreeningSegment {
  FitDataset data;    ///< all samples count
  FitSummary fitted;  ///< fitted to all samples, with its residual on the segment
};

/// Segment of the first record with the longest travel, or the whole of a short record.
[[nodiscard]] ScreeningSegment screening_segment(const FitDataset& data, const FitSummary& fitted);

}  // namespace estimator::greybox::selection
