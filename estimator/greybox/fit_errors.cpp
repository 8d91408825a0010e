#include "estimator/greybox/fit_errors.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox {

using Eigen::Index;
using Eigen::VectorXd;

void compute_errors(const EstimationProblem& question, const VectorXd& fitted,
                    SimulationErrors& before, SimulationErrors& after) {
  for (SimulationErrors* of : {&before, &after}) {
    of->rms_m = rms(of->residual_m, question.weights);
    if (question.data.validation_mask.sum() > 0.0) {
      of->heldout_rms_m = rms(of->residual_m, question.data.validation_mask);
    }
  }
  // Free run over every sample, as in `compare`.
  FitDataset all = question.data;
  for (Dataset& record : all.records) std::fill(record.valid.begin(), record.valid.end(), 1);
  DatasetSimulation free(question.model, all, question.parameters, 0.0);
  Eigen::MatrixXd points(question.start.size(), 2);
  points << question.start, fitted;
  Eigen::MatrixXd residuals_m;
  free.residuals(points, residuals_m);
  double spread_m2 = 0.0;
  for (const Dataset& record : all.records) {
    const Eigen::Map<const VectorXd> y(record.y_m.data(), static_cast<Index>(record.size()));
    spread_m2 += (y.array() - y.mean()).square().sum();
  }
  Index column = 0;
  for (SimulationErrors* of : {&before, &after}) {
    of->free_run_m = residuals_m.col(column++);
    const double square_m2 = of->free_run_m.squaredNorm();
    of->free_run_rms_m = std::sqrt(square_m2 / static_cast<double>(of->free_run_m.size()));
    of->fit_percent = 100.0 * (1.0 - std::sqrt(square_m2 / spread_m2));
  }
}

}  // namespace estimator::greybox
