// More than eight parameter sets at once: an EvidenceRun on each of several threads.
#pragma once

#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox {

class WideRun {
 public:
  /// `threads` counts the caller's; at least 1.
  WideRun(const plant_sim::ModelFile& model, const Evidence& evidence,
          const std::vector<SearchParameter>& searched, double observer_per_s, unsigned threads);

  [[nodiscard]] Eigen::Index lanes() const;
  /// evidence.size() x points.cols(); at most lanes() columns.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);
  /// For Problem::evaluate; refers to this object.
  [[nodiscard]] estimator::nonlinear::Evaluate evaluate();

 private:
  std::vector<EvidenceRun> runs_;
};

}  // namespace estimator::greybox
