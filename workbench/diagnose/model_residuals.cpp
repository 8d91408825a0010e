#include "workbench/diagnose/model_residuals.h"

namespace workbench::diagnose {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd run(const selection::DiagnosisProblem& problem,
             const std::vector<greybox::FreeParameter>& parameters, const VectorXd& theta,
             double observer_per_s) {
  greybox::DatasetSimulation runs(problem.model, problem.data, parameters, observer_per_s);
  MatrixXd residuals_m;
  runs.residuals(theta, residuals_m);
  return residuals_m.col(0);
}

}  // namespace

VectorXd residual_of_file_m(const selection::DiagnosisProblem& problem, double observer_per_s) {
  return run(problem, problem.plant_parameters,
             greybox::start_of(problem.model, problem.plant_parameters), observer_per_s);
}

VectorXd residual_of_m(const selection::DiagnosisProblem& problem,
                       const greybox::FitSummary& fitted, double observer_per_s) {
  return run(problem, fitted.parameters, fitted.theta, observer_per_s);
}

void simulate_freely(DiagnosisReport& outcome) {
  if (!outcome.fitted()) return;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  outcome.free_run_before_m = greybox::rms(residual_of_file_m(problem, 0.0), problem.data.all_mask);
  outcome.free_run_after_m =
      greybox::rms(residual_of_m(problem, outcome.diagnosis.final, 0.0), problem.data.all_mask);
}

}  // namespace workbench::diagnose
