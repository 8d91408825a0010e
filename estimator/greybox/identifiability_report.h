// What a record can tell about each parameter, and what it cannot: from the Jacobian, before and
// after the fit.
//
//   H = J' W J / sigma^2            what the record says
//   d = (H + P_others)^-1 e_j       how the others follow when parameter j is moved
//
// J W sigma of the fit; P_others the priors of all parameters but j. Where j could move by its
// prior's standard deviation and the record would not notice, the prior holds it; the parameters
// that follow name the combination that alone is visible (of logarithms: a product of powers).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox {

struct UnidentifiableParameter {
  std::string name;
  std::vector<std::string> partners;  ///< those that hide it by moving with it
  std::string visible;                ///< "gain * sqrt(pressure) and mass / pressure", or empty
  bool has_prior = false;
  std::string words;
};

struct IdentifiabilityReport {
  double condition = 0.0;  ///< of the scaled Jacobian
  /// Share of each parameter's knowledge that is the record's: 1 - (posterior sd / prior sd)^2; 1
  /// without a prior, 0 where neither record nor prior see it.
  Eigen::VectorXd share;
  std::vector<UnidentifiableParameter> unidentifiable;
};

/// `sigma` of the problem: the noise, white (before a fit: the noise floor).
[[nodiscard]] IdentifiabilityReport identifiability_report(
    const estimator::nonlinear::Problem& problem, const Eigen::MatrixXd& jacobian,
    const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta);

/// d residual / d x, all columns, and the residual.
void derivatives(const estimator::nonlinear::Problem& problem, const Eigen::VectorXd& theta,
                 Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian);

}  // namespace estimator::greybox
