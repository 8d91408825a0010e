// Information that the latest samples of a fitted window hold about its parameters.
//
//   H = sum J(k)' J(k) / s^2,   g = -sum J(k)' r(k) / s^2,   over the latest samples
//
// r J  residual and Jacobian at the fit of the whole window;  s  standard deviation of r, white
//
// H^-1 g is the Gauss-Newton step from the window's parameters to those of the tail alone, g' H^-1
// g the chi-square of their difference: large where a parameter changed within the window, largest
// at the change.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace estimator::greybox::tracking {

struct TailInformation {
  std::size_t samples = 0;
  Eigen::MatrixXd information;  ///< H with the ridge below
  Eigen::VectorXd score;        ///< g
  [[nodiscard]] Eigen::VectorXd step() const;
};

/// Tails of `spacing`, 2 `spacing`, ... samples, ascending; the last is the whole window of
/// `samples`, the last rows of the residual.
[[nodiscard]] std::vector<TailInformation> tails_of(const Eigen::VectorXd& residual,
                                                    const Eigen::MatrixXd& jacobian, double sigma,
                                                    std::size_t samples, std::size_t spacing);

/// Prior width in search units, wide against any estimate of use, that keeps H regular.
inline constexpr double kWidePrior = 3.0;

/// Chi-square of the difference between a tail and its window above which a parameter changed where
/// the tail begins.
inline constexpr double kChanged = 30.0;
/// Samples since the change; none: the window is of one piece.
[[nodiscard]] std::optional<std::size_t> samples_since_change(
    const std::vector<TailInformation>& tails);

/// Parameters that deviate from their healthy values, the strongest first. A parameter is taken
/// where its deviation lowers chi-square most, by `sure` standard errors and given those taken
/// before, and is as large as `least`. The others stay healthy: a cause explains the samples with
/// few parameters rather than with all.
struct DeviationCauses {
  std::vector<std::size_t> parameters;
  double chi_square = 0.0;  ///< lowered by so much in all
  // Per tracked parameter, with the causes free beside it:
  Eigen::VectorXd deviation;
  Eigen::VectorXd std_error;
};

/// `deviation` and `covariance`: all parameters fitted together, less their healthy values.
/// `standing`: parameters known to have changed, causes from the start.
[[nodiscard]] DeviationCauses causes_of(const Eigen::VectorXd& deviation,
                                        const Eigen::MatrixXd& covariance,
                                        const Eigen::VectorXd& least, double sure,
                                        std::vector<std::size_t> standing = {});

}  // namespace estimator::greybox::tracking
