#include "estimator/greybox/selection/innovation_curves.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "estimator/greybox/selection/screening_memo.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Gain of a curve where much physics is missing, over that of a mere remainder.
constexpr double kMuch = 3.0;

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

std::vector<CurveGain> curve_gains_anew(const InnovationStage& stage) {
  const ResidualVariables all = variables(stage.context, stage.model);
  struct Attempt {
    const Variable* variable;
    ResidualInput input;
    double gain_nats;
  };
  std::vector<Attempt> attempts;
  for (const Variable& variable : all.all) {
    for (const ResidualInput input : model_inputs(stage.context.problem.model)) {
      attempts.push_back({&variable, input, 0.0});
    }
  }
  in_parallel(attempts.size(), stage.context.options.threads, [&](std::size_t i) {
    if (stage.context.cancelled()) return;
    Attempt& attempt = attempts[i];
    const MatrixXd columns =
        input_responses(stage.context, stage.model.fitted, all, *attempt.variable, attempt.input);
    if (columns.allFinite()) attempt.gain_nats = gain_nats(stage, columns);
  });
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& a, const Attempt& b) { return a.gain_nats > b.gain_nats; });
  std::vector<CurveGain> gains;
  gains.reserve(attempts.size());
  for (const Attempt& attempt : attempts) {
    gains.push_back(
        {site_of(attempt.input), attempt.variable->name, attempt.gain_nats, attempt.input});
  }
  return gains;
}

}  // namespace

std::vector<CurveGain> curve_gains(const InnovationStage& stage) {
  const SearchContext& context = stage.context;
  const std::string key =
      context.screenings ? ScreeningMemo::key_of(context, stage.model) : std::string();
  return known_or<std::vector<CurveGain>>(context, key, [&] { return curve_gains_anew(stage); });
}

double largest_curve_nats(const InnovationStage& stage) {
  const std::vector<CurveGain> curves = curve_gains(stage);
  return curves.empty() ? 0.0 : curves.front().gain_nats;
}

bool leaves_physics(const InnovationStage& stage) {
  return largest_curve_nats(stage) > kCurve_nats;
}

bool leaves_much_physics(const InnovationStage& stage, double inexact_nats) {
  return largest_curve_nats(stage) > kMuch * (kCurve_nats + inexact_nats);
}

}  // namespace estimator::greybox::selection
