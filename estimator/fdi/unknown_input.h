// The unknown input observer: a residual that is decoupled from the disturbance d but sensitive to
// faults f.
//
//   x+ = A x + B u + E d + K f,   y = C x
//   z+ = F z + J u + G y,         r = L1 z + L2 y
//
// It exists when
//   1. rank(C E) = rank(E): y responds to d at once, and
//   2. (C, A1) is detectable, A1 = A - H C A, H = E (C E)^+.
// Then T = I - H C, F = A1 - K1 C, J = T B, G = K1 + F H, L1 = -C, L2 = I - C H: the error
// e = x - z - H y obeys e+ = F e + T K f. K1 is the gain of a steady Kalman filter for A1 and C
// with unit noises, which is stable whenever 2 holds.
//
// Limits. Each unknown input uses up one independent output: with one output and one unknown input
// nothing is left to detect a fault by. From rod position alone no disturbance of force or flow has
// an observer, since position responds to neither at once (C E = 0): measured speed or pressures
// are required. A fault that acts as d does (T K = 0) is as invisible as d. The model is linear: an
// actuator far from the operating point produces residuals of its own.
// Source: J. Chen, R. J. Patton, Robust Model-Based Fault Diagnosis for Dynamic Systems, 1999,
// ch. 3.
#pragma once

#include <Eigen/Core>
#include <string>

namespace estimator::fdi {

struct StateSpaceModel {
  Eigen::MatrixXd a;     ///< n x n
  Eigen::MatrixXd b;     ///< n x inputs
  Eigen::MatrixXd c;     ///< outputs x n
  Eigen::MatrixXd e;     ///< n x unknown inputs
  Eigen::MatrixXd k;     ///< n x faults; may have no columns
  bool discrete = true;  ///< else x' = A x + ...
};

struct Existence {
  bool exists = false;
  int rank_e = 0;
  int rank_ce = 0;
  Eigen::MatrixXd h;
  Eigen::MatrixXd a1;
  std::string why;  ///< why not, in one line
};

/// Checks both conditions; ranks by singular values with columns scaled to unit length. Throws
/// schema::ConfigError when sizes do not fit.
[[nodiscard]] Existence unknown_input_existence(const StateSpaceModel& model);

struct UnknownInputObserver {
  Eigen::MatrixXd f, j, g, l1, l2, h;
  /// Steady-state residual of a constant unit fault, outputs x faults. A column of zeros: the fault
  /// is visible as a transient at most, because the state estimate absorbs it.
  Eigen::MatrixXd fault_gain;
};

/// Observer of a discrete model. Throws schema::ConfigError with the reason when none exists. `q`:
/// process noise of predictor_gain(); a larger one follows faster.
[[nodiscard]] UnknownInputObserver unknown_input_observer(const StateSpaceModel& model,
                                                          const std::string& where, double q = 1.0);

/// Gain K1 of the steady Kalman filter x+ = A x + w, y = C x + v, cov w = q I, cov v = I, as
/// predictor: A - K1 C is stable when (C, A) is detectable.
[[nodiscard]] Eigen::MatrixXd predictor_gain(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c,
                                             double q = 1.0);

/// True when all modes that do not decay are observable in y (Popov, Belevitch, Hautus).
[[nodiscard]] bool is_detectable(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c, bool discrete);

}  // namespace estimator::fdi
