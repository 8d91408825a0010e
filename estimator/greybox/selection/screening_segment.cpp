#include "estimator/greybox/selection/screening_segment.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::selection {

using Eigen::Index;

Excerpt excerpt_of(const Evidence& evidence, const Fitted& fitted) {
  const Measured& record = evidence.records.front();
  const std::size_t length =
      std::min(record.size(), static_cast<std::size_t>(kExcerpt_s / record.sample_time_s));
  std::vector<double> way_m(record.size(), 0.0);
  for (std::size_t i = 1; i < record.size(); ++i) {
    way_m[i] = way_m[i - 1] + std::abs(record.y_m[i] - record.y_m[i - 1]);
  }
  std::size_t from = 0;
  double longest_m = -1.0;
  for (std::size_t i = 0; i + length <= record.size(); i += std::max<std::size_t>(1, length / 4)) {
    const double stretch_m = way_m[i + length - 1] - way_m[i];
    if (stretch_m > longest_m) {
      longest_m = stretch_m;
      from = i;
    }
  }
  Excerpt excerpt;
  excerpt.evidence.records = {part(record, from, from + length)};
  excerpt.evidence.starts = {0};
  excerpt.evidence.fitted_records = 1;
  excerpt.evidence.noise_floor_m = evidence.noise_floor_m;
  excerpt.evidence.sample_time_s = evidence.sample_time_s;
  const auto begin = static_cast<Index>(from);
  const auto size = static_cast<Index>(length);
  excerpt.evidence.counts.resize(size);
  for (Index i = 0; i < size; ++i) {
    excerpt.evidence.counts[i] =
        excerpt.evidence.records.front().settled[static_cast<std::size_t>(i)] != 0 ? 1.0 : 0.0;
  }
  excerpt.evidence.fits = excerpt.evidence.counts;
  excerpt.evidence.scores = excerpt.evidence.counts;
  excerpt.fitted.searched = fitted.searched;
  excerpt.fitted.x = fitted.x;
  excerpt.fitted.sigma_m = fitted.sigma_m;
  excerpt.fitted.jacobian = fitted.jacobian.middleRows(begin, size);
  excerpt.fitted.residual_m =
      fitted.residual_m.segment(begin, size).cwiseProduct(excerpt.evidence.counts);
  return excerpt;
}

}  // namespace estimator::greybox::selection
