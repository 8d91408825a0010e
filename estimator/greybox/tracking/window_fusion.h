// What the latest windows that do not overlap say together:
//
//   x = C sum Ci^-1 xi,   C = (sum Ci^-1)^-1
//
// xi Ci  what window i found and its covariance. From the newest window back, as long as each
//        agrees with those after it: d' (C + Ci)^-1 d of their difference d no greater than chance.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

struct FusedEstimate {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  int windows = 0;  ///< 0: the newest one is of no use
};

class WindowFusion {
 public:
  /// Of so many parameters; `apart` looks lie between two windows that do not overlap; `most`
  /// windows are pooled.
  WindowFusion(std::size_t parameters, std::size_t apart, std::size_t most);

  /// What the newest look found; `good`: it may be pooled.
  void add(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance, bool good);
  void clear() noexcept { looks_ = 0; }
  [[nodiscard]] FusedEstimate fused() const;
  void serialize(estimator::StateArchive& archive);

 private:
  [[nodiscard]] std::size_t at(std::size_t looks_ago) const noexcept;

  std::size_t parameters_;
  std::size_t apart_;
  std::size_t most_;
  std::size_t length_;        ///< numbers of one look: good, x, covariance
  std::vector<double> ring_;  ///< of the latest looks
  std::size_t looks_ = 0;     ///< so far
};

}  // namespace estimator::greybox::tracking
