#include "workbench/diagnose/model_residuals.h"

#include <cmath>

#include "config/signals/nan.h"
#include "estimator/greybox/law_curve.h"
#include "estimator/greybox/validation/speed_response.h"

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

VectorXd residual_of_model_m(const plant_sim::ModelFile& model, const greybox::FitDataset& data,
                             double observer_per_s) {
  const std::vector<greybox::FreeParameter> parameters = greybox::plant_parameters(model);
  return run(model, data, parameters, greybox::start_of(model, parameters), observer_per_s);
}

std::vector<double> counted_part(const VectorXd& series_m, std::size_t start,
                                 const greybox::Dataset& record) {
  std::vector<double> out(record.size(), config::signals::kNaN);
  if (series_m.size() == 0) return out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (record.valid[i] != 0) out[i] = series_m[static_cast<Eigen::Index>(start + i)];
  }
  return out;
}

VectorXd residual_of_better_m(const DiagnosisReport& outcome, double observer_per_s) {
  const selection::Diagnosis& d = outcome.diagnosis;
  return run(d.better, outcome.prepared->problem.data, d.final.parameters, d.final.theta,
             observer_per_s);
}

MatrixXd deviated_residuals_m(const DiagnosisReport& outcome, double observer_per_s) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  const std::vector<greybox::FreeParameter>& parameters = d.final.parameters;
  const auto count = static_cast<Eigen::Index>(parameters.size());
  VectorXd errors = VectorXd::Zero(count);  // of the search values
  for (Eigen::Index i = 0; i < count; ++i) {
    const greybox::FreeParameter& p = parameters[static_cast<std::size_t>(i)];
    for (const selection::ParameterValue& value : d.parameters) {
      const double slope = p.slope(d.final.theta[i]);
      if (value.name == p.name && std::isfinite(value.std_error) && slope > 0.0)
        errors[i] = value.std_error / slope;
    }
  }
  const MatrixXd points =
      greybox::deviated_theta(data, d.final, errors, greybox::ObserverSimulation::kLanes);
  if (points.cols() == 0) return {};
  greybox::DatasetSimulation runs(d.better, data, parameters, observer_per_s);
  MatrixXd residuals_m;
  runs.residuals(points, residuals_m);
  return residuals_m;
}

void simulate_freely(DiagnosisReport& outcome) {
  if (!outcome.fitted()) return;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  outcome.free_run_before_m = greybox::rms(residual_of_file_m(problem, 0.0), problem.data.all_mask);
  const VectorXd after_m = residual_of_better_m(outcome, 0.0);
  outcome.free_run_after_m = greybox::rms(after_m, problem.data.all_mask);
  if (problem.data.has_holdouts()) {
    outcome.free_run_heldout_m = greybox::rms(after_m, problem.data.validation_mask);
  }
  for (std::size_t r = 0; r < problem.data.records.size() && !outcome.resonance; ++r) {
    const greybox::Dataset& record = problem.data.records[r];
    const double* const begin = after_m.data() + problem.data.starts[r];
    outcome.resonance = greybox::validation::missing_resonance(
        record, {begin, begin + record.size()}, problem.data.noise_floor_m);
  }
}

}  // namespace workbench::diagnose
