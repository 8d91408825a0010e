#include "estimator/greybox/selection/localisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "estimator/greybox/selection/residual_input.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Range of a piece, in multiples of the residual; keeps pieces without samples near zero.
constexpr double kFreedom = 30.0;
/// Least decrease of the remaining error per additional piece.
constexpr double kPerPiece = 0.002;
/// Share of the remaining error by which the command must be better than a motion to be what a
/// force follows: a command reaches the load through the valve or the motor alone.
constexpr double kCommandAsForce = 1.25;

/// Response of the observer to an addition to the reading; independent of the model.
MatrixXd seen_by_observer(const SearchContext& context, MatrixXd added) {
  for (Index column = 0; column < added.cols(); ++column) {
    Index at = 0;
    for (const Dataset& record : context.problem.data.records) {
      std::size_t segment = 0;
      double shifted_m = 0.0;
      for (std::size_t k = 0; k < record.size(); ++k, ++at) {
        double& seen = added(at, column);
        if (segment < record.starts.size() && record.starts[segment] == k) {
          shifted_m = -seen;  // the model starts where its reading equals the measured one
          ++segment;
        }
        seen += shifted_m;
        shifted_m -= record.observer_gain(k, kObserver_per_s) * seen;
        seen *= record.valid[k] != 0 ? -1.0 : 0.0;
      }
    }
  }
  return added;
}

/// d residual / d input.
MatrixXd signatures(const SearchContext& context, const ModelStage& stage,
                    const ResidualVariables& all, const Variable& variable, ResidualInput input) {
  if (input == ResidualInput::reading || input == ResidualInput::scale) {
    return seen_by_observer(context, input_values(all, variable, input));
  }
  return input_responses(context, stage.fitted, all, variable, input);
}

/// Sums of products of all columns and the residual, over the samples that count.
MatrixXd products(const MatrixXd& columns, const VectorXd& weights) {
  const MatrixXd weighted = weights.asDiagonal() * columns;
  return weighted.transpose() * weighted;
}

/// Regression of the residual on Jacobian and signatures through sums of products. The priors keep
/// their weight of the stage's fit: freer parameters would follow what the signatures should
/// explain.
class SignatureRegression {
 public:
  SignatureRegression(const FitDataset& data, const FitSummary& fitted, const MatrixXd& signatures)
      : fitted_(fitted), parameters_(fitted_.jacobian.cols()) {
    MatrixXd columns(signatures.rows(), parameters_ + signatures.cols() + 1);
    columns << fitted_.jacobian, signatures, fitted_.residual_m;
    const bool holds_out = data.validation_mask.sum() > 0.0;
    fits_ = products(columns, data.training_mask);
    scores_ = holds_out ? products(columns, data.validation_mask) : fits_;
  }

  /// Held-out squared error that remains, relative to that without signatures and adjustment.
  [[nodiscard]] double remaining_ratio() const {
    const Index all = fits_.cols() - 1;
    const VectorXd weights = solve();
    return weights.dot(scores_ * weights) / scores_(all, all);
  }

 private:
  /// Coefficients of the columns; that of the residual is 1.
  [[nodiscard]] VectorXd solve() const {
    const Index all = fits_.cols() - 1;
    const double per_square = 1.0 / (fitted_.sigma_m * fitted_.sigma_m);
    MatrixXd normal = per_square * fits_.topLeftCorner(all, all);
    VectorXd slope = per_square * fits_.col(all).head(all);
    for (Index i = 0; i < all; ++i) {
      const double own = normal(i, i);
      if (i < parameters_) {
        const auto& parameter = fitted_.parameters[static_cast<std::size_t>(i)];
        const double sd = parameter.prior_sd;
        if (std::isfinite(sd)) {
          normal(i, i) += 1.0 / (sd * sd);
          slope[i] += (fitted_.theta[i] - parameter.prior_mean) / (sd * sd);
        } else {
          normal(i, i) += 1e-6 * own + 1e-12;
        }
      } else {
        const double total = per_square * fits_(all, all);
        normal(i, i) += own / (kFreedom * kFreedom * total) + 1e-300;
      }
    }
    VectorXd weights(all + 1);
    weights << -linear_algebra::solve_symmetric(normal, slope), 1.0;
    return weights;
  }

  const FitSummary& fitted_;
  Index parameters_;
  MatrixXd fits_, scores_;
};

struct LocalisationTrial {
  ResidualInput input;
  std::size_t variable;
  double remaining_ratio = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<Localisation> localise(const SearchContext& context, const ModelStage& stage) {
  const ResidualVariables variables = selection::variables(context, stage);
  std::vector<ResidualInput> inputs = model_inputs(context.problem.model);
  inputs.insert(inputs.end(), {ResidualInput::reading, ResidualInput::scale});
  std::vector<LocalisationTrial> attempts;
  for (std::size_t i = 0; i < variables.all.size(); ++i) {
    for (const ResidualInput input : inputs) attempts.push_back({input, i});
  }
  in_parallel(attempts.size(), context.options.threads, [&](std::size_t i) {
    if (context.cancelled()) return;
    LocalisationTrial& refine = attempts[i];
    const MatrixXd found =
        signatures(context, stage, variables, variables.all[refine.variable], refine.input);
    if (!found.allFinite()) return;
    refine.remaining_ratio =
        SignatureRegression(context.problem.data, stage.fitted, found).remaining_ratio();
  });
  if (context.cancelled()) return {};
  const auto paid = [&](const LocalisationTrial& a) {
    const auto pieces = static_cast<double>(variables.all[a.variable].pieces.cols());
    const bool remote =
        std::string_view(site_of(a.input)) == "force" && variables.all[a.variable].name == "u";
    return a.remaining_ratio * (1.0 + kPerPiece * pieces) * (remote ? kCommandAsForce : 1.0);
  };
  std::stable_sort(
      attempts.begin(), attempts.end(),
      [&](const LocalisationTrial& a, const LocalisationTrial& b) { return paid(a) < paid(b); });
  std::vector<Localisation> result;
  for (const LocalisationTrial& a : attempts) {
    const std::string& name = variables.all[a.variable].name;
    const bool named = std::any_of(result.begin(), result.end(), [&](const Localisation& where) {
      return where.variable == name;
    });
    if (named || !std::isfinite(a.remaining_ratio)) continue;
    result.push_back({site_of(a.input), name, 1.0 - a.remaining_ratio});
  }
  return result;
}

}  // namespace estimator::greybox::selection
