#include "estimator/greybox/selection/repeated_motion.h"

#include "estimator/residual/repetition.h"

namespace estimator::greybox::selection {

std::optional<RepeatedMotion> repeated_motion(const FitDataset& data,
                                              const Eigen::VectorXd& residual_m) {
  if (residual_m.size() != data.size()) return {};
  residual::RepetitionScatter all;
  std::optional<RepeatedMotion> motion;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    if (record.starts.size() > 1) continue;
    const auto size = static_cast<Eigen::Index>(record.size());
    const auto start = static_cast<Eigen::Index>(data.starts[r]);
    const std::optional<std::size_t> period =
        residual::repetition_period(Eigen::Map<const Eigen::VectorXd>(record.y_m.data(), size));
    if (!period) continue;
    all += residual::repetition_scatter(residual_m.segment(start, size),
                                        data.all_mask.segment(start, size), *period);
    if (!motion) motion = {static_cast<double>(*period) * record.sample_time_s, 0.0, 0.0};
  }
  if (!motion || !(all.scatter_freedom > 0.0)) return {};
  motion->scatter_m = all.scatter_m();
  motion->repeating_m = all.repeating_m();
  return motion;
}

}  // namespace estimator::greybox::selection
