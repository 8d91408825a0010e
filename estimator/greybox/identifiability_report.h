// Identifiability of each parameter from the Jacobian, before and after the fit.
//
//   H = J' W J / sigma^2            information of the record
//   d = (H + P_others)^-1 e_j       response of the others when parameter j is moved
//
// J, W, sigma are those of the fit; P_others holds the priors of all parameters but j. Where j can
// move by its prior's standard deviation unnoticed by the record, the prior determines it. The
// parameters that follow j give the combination that is visible: for logarithmic parameters a
// product of powers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox {

/// Combination that is visible: partner * parameter^-slope, both logarithmic.
struct VisibleProduct {
  std::size_t partner = 0;
  double slope = 0.0;  ///< d ln partner / d ln parameter along the invisible direction
};

/// Indices are those of the fitted parameters.
struct UnidentifiableParameter {
  enum class Cause {
    no_influence,  ///< the record hardly depends on the parameter
    one_partner,   ///< one other parameter compensates it
    traded         ///< several others together compensate it
  };

  std::size_t parameter = 0;
  Cause cause = Cause::no_influence;
  std::vector<std::size_t> partners;    ///< parameters that compensate it
  std::vector<VisibleProduct> visible;  ///< empty where a parameter is not logarithmic
  bool has_prior = false;               ///< the prior determines it; else it stays arbitrary
};

struct IdentifiabilityReport {
  double condition = 0.0;  ///< scaled Jacobian
  /// Share of the information on each parameter that the record contributes:
  /// 1 - (posterior sd / prior sd)^2; 1 without a prior, 0 where neither determines it.
  Eigen::VectorXd share;
  std::vector<UnidentifiableParameter> unidentifiable;
};

/// The problem's `sigma` is white noise [m]; before a fit, the noise floor.
[[nodiscard]] IdentifiabilityReport identifiability_report(
    const estimator::nonlinear::Problem& problem, const Eigen::MatrixXd& jacobian,
    const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta);

/// Residual [m] and its Jacobian d residual / d theta, all columns.
void derivatives(const estimator::nonlinear::Problem& problem, const Eigen::VectorXd& theta,
                 Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian);

}  // namespace estimator::greybox
