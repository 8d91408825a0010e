#include "workbench/diagnose/diagnosis_report.h"

#include <algorithm>

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

std::vector<std::string> taken_in(const selection::StructureSearch& search, std::size_t round) {
  const std::vector<std::string>& before = search.rounds[round].before.added;
  const std::vector<std::string>& after =
      round + 1 < search.rounds.size() ? search.rounds[round + 1].before.added : search.final.added;
  std::vector<std::string> taken;
  for (const std::string& effect : after) {
    if (std::find(before.begin(), before.end(), effect) == before.end()) taken.push_back(effect);
  }
  return taken;
}

bool stayed(const selection::StructureSearch& search, const std::vector<std::string>& effects) {
  const std::vector<std::string>& final = search.final.added;
  return std::any_of(effects.begin(), effects.end(), [&](const std::string& effect) {
    return std::find(final.begin(), final.end(), effect) != final.end();
  });
}

std::size_t deciding_round(const selection::StructureSearch& search) {
  for (std::size_t i = search.rounds.size(); i-- > 0;) {
    if (stayed(search, taken_in(search, i))) return i;
  }
  return search.rounds.size() - 1;
}

}  // namespace workbench::diagnose
