// A model with a noise model of its own, judged by the innovations of its one-step predictor.
//
//   -2 log posterior = sum e^2 / S + sum log S + sum ((theta - mean) / sd)^2
#pragma once

#include <limits>

#include "estimator/greybox/disturbance/noise_model.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// A model with its noise model, its parameters fitted to the innovations.
struct InnovationStage {
  ModelStage model;  ///< residuals: scaled innovations of all valid samples
  disturbance::NoiseModel noise;
  disturbance::Linearisations linear;  ///< about the model's trajectory
  SearchContext context;               ///< its data have the innovations
  /// Likelihood times prior, up to a constant; infinite for a stage that was not finished.
  double minus_two_log = std::numeric_limits<double>::infinity();
};

/// Fit to the innovations of the context's data: quick to compare candidates, or to convergence
/// with a Jacobian.
enum class InnovationFit {
  none,      ///< the Jacobian alone
  quick,     ///< ranks candidates
  trial,     ///< decides between candidates: to a nat or so
  converged  ///< the parameters of a model that stays
};
[[nodiscard]] FitSummary fit_innovations(const SearchContext& context,
                                         const ParameterSubset& parameters, SimulationWidth width,
                                         InnovationFit effort);

/// Squared innovations in units of the noise floor.
[[nodiscard]] double squares(const FitSummary& fitted, double floor_m);

/// Gives the stage the predictor that follows its parameters and noise model, and the likelihood
/// with that one. The Jacobian stays.
void take_own_predictor(const SearchContext& plain, InnovationStage& stage);

enum class Settling {
  once,  ///< noise model and parameters in turn, once: to compare candidates
  fully  ///< to where parameters and noise model together are likeliest
};
/// A model with a noise model of its own, both from those of `model` and `start`. `plain`: data
/// without innovations. Unfinished when cancelled.
[[nodiscard]] InnovationStage settled(const SearchContext& plain, ModelStage model,
                                      const disturbance::NoiseModel& start, Settling effort,
                                      SimulationWidth width);

/// A fit's parameters in a simulation with the weak observer, without Jacobian.
[[nodiscard]] FitSummary simulated(const SearchContext& context, const FitSummary& fitted);

}  // namespace estimator::greybox::selection
