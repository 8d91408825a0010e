#include "estimator/greybox/fit_errors.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox {

using Eigen::Index;
using Eigen::VectorXd;

void find_errors(const Task& task, const VectorXd& fitted, Errors& before, Errors& after) {
  for (Errors* of : {&before, &after}) {
    of->rms_m = rms(of->residual_m, task.weights);
    if (task.evidence.scores.sum() > 0.0) {
      of->heldout_rms_m = rms(of->residual_m, task.evidence.scores);
    }
  }
  // Free run over every sample, as `compare` has it.
  Evidence all = task.evidence;
  for (Measured& record : all.records) {
    std::fill(record.settled.begin(), record.settled.end(), 1);
  }
  EvidenceRun free(task.model, all, task.searched, 0.0);
  Eigen::MatrixXd points(task.start.size(), 2);
  points << task.start, fitted;
  Eigen::MatrixXd residuals_m;
  free.residuals(points, residuals_m);
  double spread_m2 = 0.0;
  for (const Measured& record : all.records) {
    const Eigen::Map<const VectorXd> y(record.y_m.data(), static_cast<Index>(record.size()));
    spread_m2 += (y.array() - y.mean()).square().sum();
  }
  Index column = 0;
  for (Errors* of : {&before, &after}) {
    of->free_run_m = residuals_m.col(column++);
    const double square_m2 = of->free_run_m.squaredNorm();
    of->free_run_rms_m = std::sqrt(square_m2 / static_cast<double>(of->free_run_m.size()));
    of->fit_percent = 100.0 * (1.0 - std::sqrt(square_m2 / spread_m2));
  }
}

}  // namespace estimator::greybox
