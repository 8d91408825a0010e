#include "estimator/greybox/selection/screening_segment.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::selection {

using Eigen::Index;

ScreeningSegment screening_segment(const FitDataset& data, const FitSummary& fitted) {
  const Dataset& record = data.records.front();
  const std::size_t length =
      std::min(record.size(), static_cast<std::size_t>(kScreeningSegment_s / record.sample_time_s));
  std::vector<double> travel_m(record.size(), 0.0);
  for (std::size_t i = 1; i < record.size(); ++i) {
    travel_m[i] = travel_m[i - 1] + std::abs(record.y_m[i] - record.y_m[i - 1]);
  }
  std::size_t from = 0;
  double longest_travel_m = -1.0;
  for (std::size_t i = 0; i + length <= record.size(); i += std::max<std::size_t>(1, length / 4)) {
    const double travelled_m = travel_m[i + length - 1] - travel_m[i];
    if (travelled_m > longest_travel_m) {
      longest_travel_m = travelled_m;
      from = i;
    }
  }
  ScreeningSegment segment;
  segment.data.records = {part(record, from, from + length)};
  segment.data.starts = {0};
  segment.data.fitted_records = 1;
  segment.data.noise_floor_m = data.noise_floor_m;
  segment.data.sample_time_s = data.sample_time_s;
  const auto begin = static_cast<Index>(from);
  const auto size = static_cast<Index>(length);
  segment.data.all_mask.resize(size);
  for (Index i = 0; i < size; ++i) {
    segment.data.all_mask[i] =
        segment.data.records.front().valid[static_cast<std::size_t>(i)] != 0 ? 1.0 : 0.0;
  }
  segment.data.training_mask = segment.data.all_mask;
  segment.data.validation_mask = segment.data.all_mask;
  segment.fitted.parameters = fitted.parameters;
  segment.fitted.theta = fitted.theta;
  segment.fitted.sigma_m = fitted.sigma_m;
  segment.fitted.jacobian = fitted.jacobian.middleRows(begin, size);
  segment.fitted.residual_m =
      fitted.residual_m.segment(begin, size).cwiseProduct(segment.data.all_mask);
  return segment;
}

}  // namespace estimator::greybox::selection
