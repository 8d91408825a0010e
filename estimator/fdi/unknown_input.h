// The unknown input observer: a residual that no disturbance d moves, whatever it does, but faults
// f do.
//
//   x+ = A x + B u + E d + K f,   y = C x
//   z+ = F z + J u + G y,         r = L1 z + L2 y
//
// It exists when
//   1. rank(C E) = rank(E): what d does is seen in y at once, and
//   2. (C, A1) is detectable, A1 = A - H C A, H = E (C E)^+.
// Then T = I - H C, F = A1 - K1 C, J = T B, G = K1 + F H, L1 = -C, L2 = I - C H: the error
// e = x - z - H y obeys e+ = F e + T K f. K1 is the gain of a steady Kalman filter for A1 and C
// with unit noises, which is stable whenever 2 holds.
//
// Its limits. As many independent outputs are used up as there are unknown inputs: with one output
// and one unknown input nothing is left to see a fault by. From rod position alone no disturbance
// of force or flow has an observer at all, since position answers to neither at once (C E = 0): it
// takes measured speed or pressures. A fault that acts as d does (T K = 0) is as invisible as d.
// And the model is linear: an actuator far from where it was linearised makes residuals of its own.
// Source: J. Chen, R. J. Patton, Robust Model-Based Fault Diagnosis for Dynamic Systems, 1999,
// ch. 3.
#pragma once

#include <Eigen/Core>
#include <string>

namespace estimator::fdi {

struct LinearModel {
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
  std::string why;  ///< not, in one line
};

/// Both conditions; ranks by singular values with columns scaled to unit length. Throws
/// schema::ConfigError when sizes do not fit.
[[nodiscard]] Existence unknown_input_existence(const LinearModel& model);

struct UnknownInputObserver {
  Eigen::MatrixXd f, j, g, l1, l2, h;
  /// Residual that a constant unit fault leaves behind in the end, outputs x faults. A column of
  /// zeros: the fault shows in passing at most, because the state estimate comes to explain it.
  Eigen::MatrixXd fault_gain;
};

/// Of a discrete model. Throws schema::ConfigError that says why when there is none.
/// `q`: of predictor_gain, how fast it follows.
[[nodiscard]] UnknownInputObserver unknown_input_observer(const LinearModel& model,
                                                          const std::string& where, double q = 1.0);

/// Gain K1 of the steady Kalman filter x+ = A x + w, y = C x + v, cov w = q I, cov v = I, as
/// predictor: A - K1 C is stable when (C, A) is detectable.
[[nodiscard]] Eigen::MatrixXd predictor_gain(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c,
                                             double q = 1.0);

/// Whether all modes that do not decay are seen in y (Popov, Belevitch, Hautus).
[[nodiscard]] bool is_detectable(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c, bool discrete);

}  // namespace estimator::fdi
