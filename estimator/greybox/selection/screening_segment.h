// Short segment of the data for screening.
#pragma once

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

inline constexpr double kScreeningSegment_s = 8.0;

struct ScreeningSegment {
  FitDataset data;    ///< all samples count
  FitSummary fitted;  ///< the model fitted to the whole, its residual there
};

/// The stretch of the first record with the longest way, kExcerpt_s long or the whole record.
[[nodiscard]] ScreeningSegment screening_segment(const FitDataset& data, const FitSummary& fitted);

}  // namespace estimator::greybox::selection
