// Levenberg-Marquardt for a model that evaluates several parameter sets for the price of one.
//
//   step(lambda) = argmin |R s + q|^2 + lambda |D s|^2 in the box;  accepted only when cost falls
//
// A group of `lanes` sets is the unit of work. One group takes the trial point and perturbed points
// around it: when the trial is accepted its Jacobian is there already. Lanes left over try other
// dampings. After a rejection one group tries a whole range of dampings. With more unknowns than
// lanes, `renew_all = false` renews only the oldest columns that fit into the trial's group and
// brings the others along by Broyden's update, so that an iteration stays one group.
// D: column norms, large ones fading slowly (More keeps the largest). lambda: Nielsen's rule.
// Sources: K. Madsen, H. B. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems,
// 2004; J. J. More, The Levenberg-Marquardt algorithm, 1978; C. G. Broyden, 1965.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "estimator/nonlinear/problem.h"

namespace estimator::nonlinear {

enum class StopReason {
  no_further_decrease,  ///< the linear model promises less than cost_tolerance
  small_decrease,       ///< the last accepted steps gained less than cost_tolerance
  small_step,           ///< no damping lowers the cost, down to step_tolerance
  iteration_limit,
  cancelled,
  start_not_finite,  ///< the start itself could not be evaluated
};

struct MinimizeProgress {
  int iteration = 0;
  double cost = 0.0;
  double rms = 0.0;
  const Eigen::VectorXd* x = nullptr;  ///< the best so far; valid during the call
};

struct MinimizeOptions {
  int max_iterations = 50;
  double cost_tolerance = 1e-7;  ///< relative to the cost
  double step_tolerance = 1e-9;  ///< relative to |x| (or to the difference step, if larger)
  double first_damping = 1e-3;
  bool central = false;          ///< central differences: twice the points, the error of h squared
  bool renew_all = true;         ///< false: Broyden for the columns that do not fit into the group
  bool final_jacobian = true;    ///< false: stale columns may be left in Solution::jacobian
  std::function<bool()> cancel;  ///< true ends the search, keeping the best so far
  std::function<void(const MinimizeProgress&)> progress;
  Eigen::VectorXd
      start_residual;  ///< r(start) where already known, to save evaluations; else empty
  Eigen::MatrixXd start_jacobian;  ///< likewise; columns that start with NaN are evaluated
};

struct Solution {
  Eigen::VectorXd x;
  double cost = 0.0;
  double rms = 0.0;          ///< residuals that count, in their unit
  Eigen::VectorXd residual;  ///< as evaluated, without weights
  Eigen::MatrixXd jacobian;  ///< d residual / d x, residuals x unknowns; 0 for held unknowns
  int iterations = 0;
  int evaluations = 0;  ///< groups
  int points = 0;       ///< parameter sets in them
  bool converged = false;
  StopReason reason = StopReason::iteration_limit;
  std::vector<int> at_bound;  ///< -1 at lower, +1 at upper, 0 between; held unknowns -1
  double damping = 0.0;       ///< the last lambda
};

/// `start` is moved into the bounds. The cost never increases; the result lies within the bounds.
/// Keeps no state: calls may run on several threads if `evaluate` may.
[[nodiscard]] Solution minimize(const Problem& problem, const Eigen::VectorXd& start,
                                const MinimizeOptions& options = {});

}  // namespace estimator::nonlinear
