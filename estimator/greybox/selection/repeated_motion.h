// Error of a model on records whose motion repeats: what differs between repetitions, and what
// repeats.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

struct RepeatedMotion {
  double period_s = 0.0;     ///< first record that repeats
  double scatter_m = 0.0;    ///< no model driven by the command leaves less
  double repeating_m = 0.0;  ///< follows from the motion: missing physics
};

/// `residual_m`: of the data's samples. Nothing where no record without gaps repeats its motion.
[[nodiscard]] std::optional<RepeatedMotion> repeated_motion(const FitDataset& data,
                                                            const Eigen::VectorXd& residual_m);

}  // namespace estimator::greybox::selection
