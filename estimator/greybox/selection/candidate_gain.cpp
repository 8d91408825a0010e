#include "estimator/greybox/selection/candidate_gain.h"

#include <algorithm>

#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/search_round.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kLargeGain = 0.1;
/// Fall of the priors' cost from which on an effect explains what the plant's parameters had to be
/// moved for: a parameter at its bound costs 9.
constexpr double kRelief = 12.0;

/// True where noise explains the model without effects, but with parameters at their bounds, and
/// the candidate leaves no more with none of them there.
bool relieves(const SearchContext& context, const ModelStage& stage, const Candidate& candidate) {
  const std::size_t plant = stage.fitted.parameters.size();
  return stage.added.empty() && candidate.effects.size() == 1 && is_explained(context, stage) &&
         ends_at_bound(stage.fitted, plant) && candidate.fitted.at_bound.size() >= plant &&
         !ends_at_bound(candidate.fitted, plant) &&
         candidate.validation_rms_m <= stage.fitted.validation_rms_m &&
         prior_cost(candidate.fitted) < prior_cost(stage.fitted) - kRelief;
}

}  // namespace

double worthwhile_at(const SearchContext& context, double validation_rms_m) {
  if (!floor_shows_lead(context.problem.data)) return kWorthwhileInSlowLogs;
  return validation_rms_m < kUnexplained * context.problem.data.noise_floor_m ? kWorthwhileInNoise
                                                                              : kWorthwhile;
}

bool is_gain(const SearchContext& context, const ModelStage& stage, const Candidate& candidate) {
  // between the samples of a slow log the command is not known: that error may be all there is
  if (!floor_shows_lead(context.problem.data) && is_explained(context, stage)) return false;
  const double worthwhile = worthwhile_at(context, stage.fitted.validation_rms_m);
  const double gain = 1.0 - candidate.validation_rms_m / stage.fitted.validation_rms_m;
  const double fit_gain = 1.0 - candidate.fitted.training_rms_m / stage.fitted.training_rms_m;
  const double enough = worthwhile * static_cast<double>(candidate.effects.size());
  // gain that chance gives this number of parameters over the independent samples
  const Eigen::VectorXd& fitted = context.problem.data.training_mask;
  const double by_chance =
      kPerParameter_nats *
      static_cast<double>(candidate.fitted.parameters.size() - stage.fitted.parameters.size()) *
      correlation_factor(candidate.fitted.residual_m, fitted) / fitted.sum();
  // not chance: better on the validation samples throughout, or, where noise does not explain the
  // stage, equally better on the training samples
  const bool fits_better = fit_gain > enough + by_chance && !is_explained(context, stage);
  const bool better =
      gain > enough && (gain > kLargeGain || candidate.p_value < kChance || fits_better);
  return candidate.fitted_at_all && (better || relieves(context, stage, candidate)) &&
         !leaves_its_range(candidate.fitted, stage.fitted.parameters.size());
}

}  // namespace estimator::greybox::selection
