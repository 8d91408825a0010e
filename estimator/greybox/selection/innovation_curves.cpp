#include "estimator/greybox/selection/innovation_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/selection/residual_variables.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sizes of the added force and command that keep to the linear part of the response, RMS.
constexpr double kSmall_N = 10.0;
constexpr double kSmall_ratio = 0.02;

enum class Form { flow, gain, force, drag };

const char* site_of(Form form) {
  switch (form) {
    case Form::flow:
      return "flow";
    case Form::gain:
      return "gain";
    case Form::force:
    case Form::drag:
      break;
  }
  return "force";
}

double rms_of(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(std::max<Index>(1, values.size())));
}

MatrixXd inputs(const Variables& all, const Variable& variable, Form form) {
  if (form == Form::gain) return all.command_V.asDiagonal() * variable.pieces;
  if (form == Form::drag) return all.speed_mps.asDiagonal() * variable.pieces;
  return variable.signed_pieces.cols() > 0 ? variable.signed_pieces : variable.pieces;
}

/// Change of the innovations, one column per piece; empty where the input is zero.
MatrixXd responses(const InnovationStage& stage, const Variables& all, MatrixXd added, Form form) {
  const double whole = rms_of(added.rowwise().sum());
  if (!(whole > 0.0)) return {};
  const bool force = form == Form::force || form == Form::drag;
  added *= (force ? kSmall_N : kSmall_ratio * rms_of(all.command_V)) / whole;
  DatasetSimulation run(stage.context.problem.model, stage.context.problem.data,
                        stage.model.fitted.parameters);
  MatrixXd residuals_m;
  const MatrixXd none;
  run.residuals(stage.model.fitted.theta.replicate(1, added.cols()), force ? none : added,
                force ? added : none, residuals_m);
  residuals_m.colwise() -= stage.model.fitted.residual_m;
  return residuals_m;
}

/// Half the fall of the squared innovations, in units of the floor, when the columns join the
/// Jacobian, whose parameters their priors hold.
double gain_nats(const InnovationStage& stage, const MatrixXd& columns) {
  const FitSummary& fitted = stage.model.fitted;
  const double floor_m = stage.context.problem.data.noise_floor_m;
  const Index own = fitted.jacobian.cols();
  MatrixXd all(columns.rows(), own + columns.cols());
  all << fitted.jacobian, columns;
  all /= floor_m;
  const VectorXd residual = fitted.residual_m / floor_m;
  MatrixXd normal = all.transpose() * all;
  VectorXd slope = all.transpose() * residual;
  const auto explained = [&](Index count) {
    MatrixXd held = normal.topLeftCorner(count, count);
    VectorXd onto = slope.head(count);
    for (Index i = 0; i < count; ++i) {
      if (i < own) {
        const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
        if (std::isfinite(p.prior_sd)) {
          held(i, i) += 1.0 / (p.prior_sd * p.prior_sd);
          onto[i] += (fitted.theta[i] - p.prior_mean) / (p.prior_sd * p.prior_sd);
        }
      }
      held(i, i) += 1e-9 * held(i, i) + 1e-12;
    }
    return onto.dot(linear_algebra::solve_symmetric(held, onto));
  };
  return 0.5 * (explained(all.cols()) - explained(own));
}

}  // namespace

std::vector<CurveGain> curve_gains(const InnovationStage& stage) {
  const Variables all = variables(stage.context, stage.model);
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(stage.context.problem.model.plant);
  const bool forces =
      std::find(plant.sites.begin(), plant.sites.end(), "force") != plant.sites.end();
  struct Attempt {
    const Variable* variable;
    Form form;
    double gain_nats;
  };
  std::vector<Attempt> attempts;
  for (const Variable& variable : all.all) {
    for (const Form form : {Form::flow, Form::gain, Form::force, Form::drag}) {
      if (!forces && (form == Form::force || form == Form::drag)) continue;
      attempts.push_back({&variable, form, 0.0});
    }
  }
  in_parallel(attempts.size(), stage.context.options.threads, [&](std::size_t i) {
    if (stage.context.cancelled()) return;
    Attempt& attempt = attempts[i];
    const MatrixXd columns =
        responses(stage, all, inputs(all, *attempt.variable, attempt.form), attempt.form);
    if (columns.cols() > 0 && columns.allFinite()) attempt.gain_nats = gain_nats(stage, columns);
  });
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& a, const Attempt& b) { return a.gain_nats > b.gain_nats; });
  std::vector<CurveGain> gains;
  for (const Attempt& attempt : attempts) {
    gains.push_back({site_of(attempt.form), attempt.variable->name, attempt.gain_nats});
  }
  return gains;
}

}  // namespace estimator::greybox::selection
