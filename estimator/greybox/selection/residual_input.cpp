#include "estimator/greybox/selection/residual_input.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/dataset_simulation.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// RMS sizes of an input at which the response is linear; of a command, relative.
constexpr double kSmall_ratio = 0.02;
constexpr double kSmall_N = 10.0;

double rms_of(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(std::max<Index>(1, values.size())));
}

}  // namespace

const char* site_of(ResidualInput input) {
  switch (input) {
    case ResidualInput::flow:
      return "flow";
    case ResidualInput::gain:
      return "gain";
    case ResidualInput::force:
    case ResidualInput::drag:
      return "force";
    case ResidualInput::reading:
    case ResidualInput::scale:
      break;
  }
  return "measurement";
}

std::vector<ResidualInput> model_inputs(const plant_sim::ModelFile& model) {
  std::vector<ResidualInput> inputs{ResidualInput::flow, ResidualInput::gain};
  const std::vector<std::string>& sites = plant_sim::find_plant(model.plant)->sites;
  if (std::find(sites.begin(), sites.end(), "force") != sites.end()) {
    inputs.insert(inputs.end(), {ResidualInput::force, ResidualInput::drag});
  }
  return inputs;
}

MatrixXd input_values(const ResidualVariables& all, const Variable& variable, ResidualInput input) {
  switch (input) {
    case ResidualInput::gain:
      return all.command_V.asDiagonal() * variable.pieces;
    case ResidualInput::drag:
      return all.speed_mps.asDiagonal() * variable.pieces;
    case ResidualInput::scale:
      return all.position_m.asDiagonal() * variable.pieces;
    case ResidualInput::flow:
    case ResidualInput::force:
    case ResidualInput::reading:
      break;
  }
  return variable.signed_pieces.cols() > 0 ? variable.signed_pieces : variable.pieces;
}

MatrixXd input_responses(const SearchContext& context, const FitSummary& fitted,
                         const ResidualVariables& all, const Variable& variable,
                         ResidualInput input) {
  MatrixXd added = input_values(all, variable, input);
  const bool force = input == ResidualInput::force || input == ResidualInput::drag;
  const double whole = rms_of(added.rowwise().sum());
  if (!(whole > 0.0)) return MatrixXd::Zero(added.rows(), added.cols());
  const double size = force ? kSmall_N : kSmall_ratio * rms_of(all.command_V);
  added *= size / whole;
  DatasetSimulation run(context.problem.model, context.problem.data, fitted.parameters);
  const MatrixXd points = fitted.theta.replicate(1, added.cols());
  MatrixXd residuals_m;
  const MatrixXd none;
  run.residuals(points, force ? none : added, force ? added : none, residuals_m);
  residuals_m.colwise() -= fitted.residual_m;
  return residuals_m * (whole / size);
}

}  // namespace estimator::greybox::selection
