// Error of the integration step: what a model's simulation changes by with a step of a quarter, and
// how far that moves its parameters. Stick-slip and stiff contacts need shorter steps than the
// hydraulics; the parameters then make up for the step, many standard errors off.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

struct StepError {
  double rms_m = 0.0;     ///< RMS of the simulation's change
  Eigen::VectorXd shift;  ///< of each theta
};

/// `fitted` with its Jacobian, a fit to the samples of `weights`.
[[nodiscard]] StepError step_error(const SearchContext& context, const FitSummary& fitted,
                                   const Eigen::VectorXd& weights, double observer_per_s);

/// True where the error of its integration step may be much of what a fit near the noise leaves: an
/// effect would stand for that.
[[nodiscard]] bool may_be_step_error(const SearchContext& context, const FitSummary& fitted);

/// The problem with the finer integration step that its own is held against; none below a model
/// file's least.
[[nodiscard]] std::optional<DiagnosisProblem> with_finer_step(const DiagnosisProblem& problem);

}  // namespace estimator::greybox::selection
