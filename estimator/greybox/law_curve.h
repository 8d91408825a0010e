// A formula of a model as a curve over one of its variables, with its standard error:
//
//   f(x) = formula(x) - none(x)        none: what the site has without it, its variable or 0
//   std_error(x)^2 = g' C g            g = d f / d parameters, C their covariance
//
// The curve covers what the records visit and no more: beyond, they say nothing of the law.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

struct LawCurve {
  struct Held {
    std::string variable;
    double value = 0.0;
  };

  std::string variable;      ///< the formula's, "v_mps"; `x` in its unit
  std::string quantity;      ///< what `f` is, with its unit: "force_N"
  std::optional<Held> held;  ///< the formula's other variable, where it depends on it
  std::vector<double> x, f;
  std::vector<double> std_error;  ///< NaN: not known
  /// Share of the counted samples about each x; empty where the records do not show the variable.
  std::vector<double> share;
};

/// Covariance of some fitted parameters, in their units: `errors` (NaN at a bound: taken as
/// exact there) with the correlations of the fit. Where it left no Jacobian they are unknown, and
/// each pair counts as correlated as is worst: empty. Names that were not fitted have rows of
/// zeros.
[[nodiscard]] Eigen::MatrixXd covariance_of(const FitDataset& data, const FitSummary& fitted,
                                            const std::vector<std::string>& names,
                                            const Eigen::VectorXd& errors);

/// Search values a standard deviation away from the fitted ones along each of the `most` widest
/// directions of their uncertainty, within their bounds, one column each; `errors` are those of the
/// search values. No columns where all errors are zero.
[[nodiscard]] Eigen::MatrixXd deviated_theta(const FitDataset& data, const FitSummary& fitted,
                                             const Eigen::VectorXd& errors, Eigen::Index most);

/// Curve of `effect`, a formula of the model, over the variable that the site has for "y", "v" or
/// any other, the first. The other one is held: the position at its mean, the speed at its RMS,
/// pressures at half the range. `errors` are those of its parameters, in their order, `covariance`
/// as above.
[[nodiscard]] LawCurve law_curve(const plant_sim::ModelFile& model, const FitDataset& data,
                                 std::string_view effect, std::string_view over,
                                 const Eigen::VectorXd& errors, const Eigen::MatrixXd& covariance);

}  // namespace estimator::greybox
