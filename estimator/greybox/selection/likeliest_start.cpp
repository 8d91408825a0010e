#include "estimator/greybox/selection/likeliest_start.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/sensor_place.h"

namespace estimator::greybox::selection {

namespace {

constexpr double kTriedShares[] = {0.15, 0.3, 0.6};
constexpr double kTriedDamping_ratio = 0.02;
/// Fall of -2 log L below which a step of a noise model's search is the last.
constexpr double kLastStep = 1.0;

/// True where the model at these values has a second mass.
bool has_swing(const plant_sim::ModelFile& model, const FitSummary& at) {
  return has_second_mass(*disturbance::model_ensemble(model, model.step_s, at.parameters, at.theta),
                         0);
}

}  // namespace

LikeliestStart likeliest_start(const SearchContext& plain, std::vector<ParameterSubset> starts,
                               const disturbance::NoiseModel& noise, unsigned threads) {
  const DiagnosisProblem& problem = plain.problem;
  LikeliestStart best;
  best.force_place = noise.force_place;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    FitSummary at;
    at.parameters = starts[i].parameters;
    at.theta = starts[i].start;
    std::vector<double> places = {noise.force_place};
    const bool swings = has_swing(problem.model, at);
    if (swings) places = {0.0, 1.0};
    if (!swings && starts.size() == 1) break;
    for (const double place : places) {
      if (plain.cancelled()) break;
      disturbance::NoiseModel placed = noise;
      placed.force_place = place;
      const disturbance::Linearisations linear =
          disturbance::linearise(problem.model, problem.data, at.parameters, at.theta, place);
      const double cost =
          prior_cost(at) + disturbance::estimate_noise(problem.model, problem.data, at.parameters,
                                                       at.theta, linear, placed, threads, kLastStep)
                               .minus_two_log_likelihood;
      if (!(cost < best.minus_two_log)) continue;
      best.minus_two_log = cost;
      best.force_place = place;
      chosen = i;
    }
  }
  best.start = std::move(starts[chosen]);
  return best;
}

std::vector<ParameterSubset> mass_share_starts(const ParameterSubset& start) {
  const bool resonates =
      std::any_of(start.parameters.begin(), start.parameters.end(),
                  [](const FreeParameter& p) { return p.name == "second_mass.resonance_Hz"; });
  if (!resonates) return {};
  std::vector<ParameterSubset> starts;
  for (const double share : kTriedShares) {
    ParameterSubset& with = starts.emplace_back(start);
    for (std::size_t i = 0; i < with.parameters.size(); ++i) {
      const FreeParameter& p = with.parameters[i];
      double& theta = with.start[static_cast<Eigen::Index>(i)];
      if (p.name == "second_mass.mass_ratio") theta = p.to_theta(share);
      if (p.name == "second_mass.damping_ratio") theta = p.to_theta(kTriedDamping_ratio);
      if (p.name == "second_mass.sensor_ratio") theta = p.to_theta(1.0);
      theta = std::clamp(theta, p.lower, p.upper);
    }
  }
  return starts;
}

}  // namespace estimator::greybox::selection
