#include "estimator/greybox/selection/localisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "estimator/greybox/disturbance/noise_model.h"
#include "estimator/greybox/kinematics.h"
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
/// The remaining squared error of another site over that of the best, up to which the record does
/// not tell the two: what is left is a fault of the curves as well as of the place.
constexpr double kToldApart = 2.0;
/// Share of the remaining error by which the command must be better than a motion to be what a
/// force follows: a command reaches the load through the valve or the motor alone.
constexpr double kCommandAsForce = 1.25;

/// Response of the observer to an addition to the reading, by the linearised model: on an axis
/// driven by force, the observer finds the speed too while a segment settles.
MatrixXd seen_by_observer(const SearchContext& context, const disturbance::Linearisations& linear,
                          MatrixXd added) {
  for (Index column = 0; column < added.cols(); ++column) {
    Index at = 0;
    for (std::size_t r = 0; r < linear.size(); ++r) {
      const Dataset& record = context.problem.data.records[r];
      const disturbance::Linearisation& model = linear[r];
      const PlantStart start = disturbance::start_of(model.states);
      const auto speed = std::find(model.states.begin(), model.states.end(), "v_mps");
      disturbance::StateVector shifted = disturbance::StateVector::Zero();
      std::size_t segment = 0;
      for (std::size_t k = 0; k < record.size(); ++k, ++at) {
        double& seen = added(at, column);
        if (segment < record.starts.size() && record.starts[segment] == k) {
          shifted.setZero();
          shifted[0] = -seen;  // the model starts where its reading equals the measured one
          ++segment;
        }
        seen += shifted[0];
        const ObserverGain gain = record.observer_gain(k, kObserver_per_s, start);
        shifted[0] -= gain.position * seen;
        if (gain.speed_per_s > 0.0)
          shifted[speed - model.states.begin()] -= gain.speed_per_s * seen;
        shifted = model.transition[k] * shifted;
        seen *= record.valid[k] != 0 ? -1.0 : 0.0;
      }
    }
  }
  return added;
}

/// The model's speed, acceleration and jerk, per sample: what a short lag adds to the reading.
MatrixXd shifts_by_lag(const SearchContext& context, const VectorXd& speed_mps) {
  MatrixXd shifts = MatrixXd::Zero(speed_mps.size(), 3);
  shifts.col(0) = speed_mps;
  for (Index order = 1; order < shifts.cols(); ++order) {
    Index at = 0;
    for (const Dataset& record : context.problem.data.records) {
      for (const SampleRange& span : segments(record)) {
        for (std::size_t k = span.begin + 1; k + 1 < span.end; ++k) {
          const Index row = at + static_cast<Index>(k);
          shifts(row, order) = 0.5 * (shifts(row + 1, order - 1) - shifts(row - 1, order - 1));
        }
      }
      at += static_cast<Index>(record.size());
    }
  }
  return shifts;
}

/// d residual / d input.
MatrixXd signatures(const SearchContext& context, const ModelStage& stage,
                    const disturbance::Linearisations& linear, const ResidualVariables& all,
                    const Variable& variable, ResidualInput input) {
  if (input == ResidualInput::reading || input == ResidualInput::scale) {
    return seen_by_observer(context, linear, input_values(all, variable, input));
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
  double paid_ratio = std::numeric_limits<double>::infinity();  ///< its pieces paid for
};

/// A site and the least that it leaves unexplained.
struct SiteTrial {
  std::string site;
  double paid_ratio;
};

/// Sites other than `site` that leave less than kToldApart times `paid_ratio`; `sites` best first.
std::vector<std::string> not_told_apart(const std::vector<SiteTrial>& sites,
                                        const std::string& site, double paid_ratio) {
  std::vector<std::string> others;
  for (const SiteTrial& other : sites) {
    const bool known =
        other.site == site || std::find(others.begin(), others.end(), other.site) != others.end();
    if (!known && other.paid_ratio < kToldApart * paid_ratio) others.push_back(other.site);
  }
  return others;
}

}  // namespace

std::vector<Localisation> localise(const SearchContext& context, const ModelStage& stage) {
  const ResidualVariables variables = selection::variables(context, stage);
  std::vector<ResidualInput> inputs = model_inputs(context.problem.model);
  inputs.insert(inputs.end(), {ResidualInput::reading, ResidualInput::scale});
  std::vector<LocalisationTrial> attempts;
  for (std::size_t i = 0; i < variables.all.size(); ++i) {
    for (const ResidualInput input : inputs) attempts.push_back({input, i});
  }
  const disturbance::Linearisations linear = disturbance::linearise(
      context.problem.model, context.problem.data, stage.fitted.parameters, stage.fitted.theta);
  const auto remaining_ratio = [&](const MatrixXd& found) {
    return SignatureRegression(context.problem.data, stage.fitted, found).remaining_ratio();
  };
  const auto paid = [](double ratio, Index pieces) {
    return ratio * (1.0 + kPerPiece * static_cast<double>(pieces));
  };
  in_parallel(attempts.size(), context.options.threads, [&](std::size_t i) {
    if (context.cancelled()) return;
    LocalisationTrial& trial = attempts[i];
    const Variable& variable = variables.all[trial.variable];
    const MatrixXd found = signatures(context, stage, linear, variables, variable, trial.input);
    if (!found.allFinite()) return;
    trial.remaining_ratio = remaining_ratio(found);
    const bool remote = std::string_view(site_of(trial.input)) == "force" && variable.name == "u";
    trial.paid_ratio =
        paid(trial.remaining_ratio, variable.pieces.cols()) * (remote ? kCommandAsForce : 1.0);
  });
  if (context.cancelled()) return {};
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const LocalisationTrial& a, const LocalisationTrial& b) {
                     return a.paid_ratio < b.paid_ratio;
                   });
  std::vector<SiteTrial> sites;
  for (const LocalisationTrial& a : attempts) {
    if (std::isfinite(a.paid_ratio)) sites.push_back({site_of(a.input), a.paid_ratio});
  }
  const MatrixXd lag =
      seen_by_observer(context, linear, shifts_by_lag(context, variables.speed_mps));
  if (lag.allFinite()) sites.push_back({"lag", paid(remaining_ratio(lag), lag.cols())});
  std::stable_sort(sites.begin(), sites.end(), [](const SiteTrial& a, const SiteTrial& b) {
    return a.paid_ratio < b.paid_ratio;
  });
  std::vector<Localisation> result;
  for (const LocalisationTrial& a : attempts) {
    const std::string& name = variables.all[a.variable].name;
    const bool named = std::any_of(result.begin(), result.end(), [&](const Localisation& where) {
      return where.variable == name;
    });
    if (named || !std::isfinite(a.remaining_ratio)) continue;
    const std::string site = site_of(a.input);
    result.push_back(
        {site, name, 1.0 - a.remaining_ratio, not_told_apart(sites, site, a.paid_ratio)});
  }
  return result;
}

}  // namespace estimator::greybox::selection
