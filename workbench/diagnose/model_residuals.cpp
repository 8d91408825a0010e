#include "workbench/diagnose/model_residuals.h"

namespace workbench::diagnose {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd run(const plant_sim::ModelFile& model, const greybox::FitDataset& data,
             const std::vector<greybox::FreeParameter>& parameters, const VectorXd& theta,
             double observer_per_s) {
  greybox::DatasetSimulation runs(model, data, parameters, observer_per_s);
  MatrixXd residuals_m;
  runs.residuals(theta, residuals_m);
  return residuals_m.col(0);
}

}  // namespace

VectorXd residual_of_file_m(const selection::DiagnosisProblem& problem, double observer_per_s) {
  return run(problem.model, problem.data, problem.plant_parameters,
             greybox::start_of(problem.model, problem.plant_parameters), observer_per_s);
}

VectorXd residual_of_m(const selection::DiagnosisProblem& problem,
                       const greybox::FitSummary& fitted, double observer_per_s) {
  return run(problem.model, problem.data, fitted.parameters, fitted.theta, observer_per_s);
}

VectorXd residual_of_better_m(const DiagnosisReport& outcome, double observer_per_s) {
  const selection::Diagnosis& d = outcome.diagnosis;
  return run(d.better, outcome.prepared->problem.data, d.final.parameters, d.final.theta,
             observer_per_s);
}

void simulate_freely(DiagnosisReport& outcome) {
  if (!outcome.fitted()) return;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  outcome.free_run_before_m = greybox::rms(residual_of_file_m(problem, 0.0), problem.data.all_mask);
  outcome.free_run_after_m =
      greybox::rms(residual_of_better_m(outcome, 0.0), problem.data.all_mask);
}

}  // namespace workbench::diagnose
