// Prediction-error fit of a polynomial model: the coefficients that minimise the energy of the
// one-step errors, by Levenberg-Marquardt from several starts.
//
//   V(theta) = sum e(t, theta)^2,   e = D/C (A y - B/F u)
//   cov theta = H^-1 (J' Gamma J) H^-1,  H = J' J,  Gamma: covariance of e
//
// For white e (the structure holds the noise's colour) that is s^2 H^-1 and the fit is efficient,
// also in closed loop. Output error leaves a coloured e: its errors count the colour, but in closed
// loop its coefficients are biased. ARX, linear in theta, is solved directly.
// Source: L. Ljung, System Identification, chapters 7, 9, 10 and 13.4; T. Soderstrom, P. Stoica,
// System Identification, chapter 7.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "estimator/structures/polynomial.h"

namespace estimator::structures {

struct PredictionErrorOptions {
  int max_iterations = 60;
  std::vector<Polynomial> starts{};  ///< tried besides the usual ones, or alone:
  bool only_these_starts = false;
  bool errors = true;  ///< false: std_error and condition stay NaN
  std::function<bool()> cancel{};
};

struct PolynomialFit {
  Orders orders;
  Polynomial model;
  std::vector<double> value;      ///< in the order of Orders::names()
  std::vector<double> std_error;  ///< infinite where the data do not determine it
  double condition = 0.0;         ///< 2-norm, of the Jacobian of e with columns scaled to length 1
  double residual_rms_m = 0.0;
  int samples = 0;  ///< errors that were minimised
  int starts = 0;   ///< tried
  bool converged = false;
  bool valid = false;
  std::string why;  ///< reason of an invalid fit
};

[[nodiscard]] PolynomialFit fit_prediction_error(const Orders& orders, const Stretches& data,
                                                 const PredictionErrorOptions& options = {});

/// The least number of samples that fit_prediction_error() takes for these orders.
[[nodiscard]] int least_samples(const Orders& orders);

}  // namespace estimator::structures
