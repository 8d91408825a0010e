// Covariance of the parameters at a solution, also when the residual is not white.
//
//   H = J' W J / sigma^2 + P,   C = H^-1 (J' W Gamma W J / sigma^4 + P) H^-1
//
//   J, W, sigma  Jacobian, weights, the sigma that weighted the fit;  P: precision of the priors
//   Gamma        covariance of the residuals: s^2 I (white), that of a fitted autoregression
//                (coloured: any colour, the same everywhere), or from the scores J_t r_t themselves
//                (scores: the colour and size may depend on the motion; needs long records)
//
// The autoregression's Gamma = s_w^2 L L' is never formed: L' J is J filtered backwards in time.
// The scores' sum over lags has Bartlett weights, after prewhitening.
// Parameters at a bound are left out (the others' figures hold given that bound) and flagged;
// directions that neither data nor prior see give infinite errors.
// Sources: P. J. Huber 1967; W. K. Newey, K. D. West, Econometrica 55 (1987) 703; D. W. K. Andrews,
// J. C. Monahan, Econometrica 60 (1992) 953; L. Ljung, System Identification, 9.2.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/nonlinear/minimize.h"

namespace estimator::nonlinear {

enum class Colour { white, coloured, scores };
enum class Standing {
  estimated,
  at_bound,  ///< std_error NaN; low = high = value
  held,      ///< lower == upper: likewise
  unseen,    ///< neither data nor prior see it: std_error infinite, interval = the bounds
};

struct CovarianceOptions {
  Colour colour = Colour::coloured;
  /// The noise's standard deviation where known; NaN: from the residual. The scores ignore it.
  double noise_sd = kNaN;
  /// First rows of further series that follow the first one in the residual, each with a colour and
  /// size of its own (of white and coloured), independent of the others; ascending.
  std::vector<Eigen::Index> series;
};

struct Covariance {
  Eigen::VectorXd std_error;
  Eigen::VectorXd low;  ///< 95 % interval, limited by the bounds
  Eigen::VectorXd high;
  Eigen::MatrixXd matrix;  ///< zero rows and columns where not estimated
  std::vector<Standing> standing;
  Eigen::VectorXd inflation;  ///< (std_error / that for white noise of Problem::sigma)^2
  double noise_sd = 0.0;      ///< used, or found in the residual
  double effective_samples =
      0.0;  ///< number of independent samples with the same error of the mean
};

[[nodiscard]] Covariance covariance(const Problem& problem, const Solution& solution,
                                    const CovarianceOptions& options = {});

}  // namespace estimator::nonlinear
