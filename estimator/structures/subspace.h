// State-space model from the singular value decomposition of what the past says about the future;
// no search, no start values.
//
//   x(t+1) = A x(t) + B u(t-k+1) + b0 + K e(t),   y(t) = C x(t) + c0 + e(t)
//
//   past  p_t = [u(t-k) y(t-1) u(t-k-1) y(t-2) ...],  future  y_t .. y_(t+h-1), inputs f_t
//   N4SID:      Theta p_t from the regression of the future on p_t and f_t (oblique projection)
//   predictor:  Theta from the coefficients of one long ARX, row j shifted j places
//   Theta P = U S V',   x(t) = S^(-1/2) U' Theta p_t  of the wanted order
//   then C, c0, e from y on x;  A, B, b0, K from x(t+1) on x, u, e
//
// N4SID regresses on future inputs; in closed loop those know the noise and bias Theta. The
// predictor form uses past data only and is consistent there as well. Standard errors have no
// simple form: judge by the scatter between periods.
// Sources: P. Van Overschee, B. De Moor, Subspace Identification for Linear Systems, 1996, chapter
// 4; A. Chiuso, Automatica 43 (2007) 1034 (PBSID); L. Ljung, System Identification, 10.6.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "estimator/structures/polynomial.h"

namespace estimator::structures {

enum class SubspaceMethod : std::uint8_t { n4sid, predictor };

struct SubspaceOptions {
  int order = 2;
  int k = 1;
  bool constant = true;
  SubspaceMethod method = SubspaceMethod::predictor;
  int past = 15;    ///< samples
  int future = 10;  ///< samples, more than `order`
};

struct SubspaceFit {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;  ///< 1/V: y is scaled back in C
  Eigen::RowVectorXd C;
  Eigen::VectorXd K;
  Eigen::VectorXd singular_values;  ///< singular values of Theta P, largest first, dimensionless
  double condition = 0.0;  ///< condition of the regression on the past, columns scaled to length 1
  /// The same model as a difference equation: characteristic polynomials of A (a) and of A - K C
  /// (c), numerator (b); independent of the choice of basis.
  Polynomial model;
  int samples = 0;
  bool valid = false;
  std::string why;
};

[[nodiscard]] SubspaceFit fit_subspace(const SubspaceOptions& options, const Stretches& data);

/// Least number of samples in one stretch.
[[nodiscard]] int least_samples(const SubspaceOptions& options);

}  // namespace estimator::structures
