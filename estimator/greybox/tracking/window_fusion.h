// Fusion of the latest windows that do not overlap:
//
//   theta = C sum Ci^-1 theta_i,   C = (sum Ci^-1)^-1
//
// theta_i, Ci  estimate and covariance of window i, from the newest back, while each agrees with
//              those after it: d' (C + Ci)^-1 d of their difference d within chance.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

struct FusedEstimate {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  int windows = 0;  ///< 0: the newest window is not usable
};

class WindowFusion {
 public:
  /// `parameters`: number of parameters; `apart`: windows between two that do not overlap; `most`:
  /// limit of fused windows.
  WindowFusion(std::size_t parameters, std::size_t apart, std::size_t most);

  /// Adds the newest window; `good`: may be fused.
  void add(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance, bool good);
  void clear() noexcept { looks_ = 0; }
  [[nodiscard]] FusedEstimate fused() const;
  void serialize(estimator::StateArchive& archive);

 private:
  [[nodiscard]] std::size_t at(std::size_t looks_ago) const noexcept;

  std::size_t parameters_;
  std::size_t apart_;
  std::size_t most_;
  std::size_t length_;        ///< numbers per window: good, theta, covariance
  std::vector<double> ring_;  ///< latest windows
  std::size_t looks_ = 0;     ///< windows so far
};

}  // namespace estimator::greybox::tracking
