// The state of one minimisation and its steps; see minimize.h for the method.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/nonlinear/difference.h"
#include "estimator/nonlinear/linear_model.h"
#include "estimator/nonlinear/minimize.h"

namespace estimator::nonlinear {

/// One search: the point, its linearisation, the damping.
class Search {
 public:
  Search(const Problem& problem, const MinimizeOptions& options)
      : problem_(problem), options_(options), groups_(problem), p_(problem.size()) {}

  Solution run(const Eigen::VectorXd& start);

 private:
  bool begin(const Eigen::VectorXd& start);
  /// One accepted step, or the reason why there is none.
  bool iterate();
  bool scan();
  void linearise();
  void renew(const std::vector<Eigen::Index>& columns);
  void broyden(const Eigen::VectorXd& step, const Eigen::VectorXd& residual);
  void move_to(const Eigen::VectorXd& x, const Eigen::VectorXd& residual, double cost);
  [[nodiscard]] Eigen::VectorXd step_for(double lambda) const;
  [[nodiscard]] Eigen::VectorXd inside(Eigen::VectorXd x) const;
  [[nodiscard]] std::vector<Eigen::Index> stale() const;
  [[nodiscard]] bool is_small(const Eigen::VectorXd& step) const;
  bool stop(StopReason reason, bool converged) {
    out_.reason = reason;
    out_.converged = converged;
    return false;
  }

  const Problem& problem_;
  const MinimizeOptions& options_;
  Groups groups_;
  Eigen::Index p_;
  Eigen::VectorXd x_;
  Eigen::VectorXd r_;
  Eigen::MatrixXd J_;
  std::vector<int> age_;  // iterations since a column was evaluated; 0 = at x
  double cost_ = 0.0;
  LinearModel model_;
  Eigen::VectorXd D_;
  Eigen::VectorXd low_;
  Eigen::VectorXd high_;
  double lambda_ = 0.0;
  int small_ = 0;
  Solution out_;
};

}  // namespace estimator::nonlinear
