#include "estimator/greybox/selection/likeliest_start.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace estimator::greybox::selection {

namespace {

constexpr double kTriedShares[] = {0.15, 0.3, 0.6};
constexpr double kTriedDamping_ratio = 0.02;
/// Fall of -2 log L below which a step of a noise model's search is the last.
constexpr double kLastStep = 1.0;

}  // namespace

LikeliestStart likeliest_start(const SearchContext& plain, std::vector<ParameterSubset> starts,
                               const disturbance::NoiseModel& noise, unsigned threads) {
  if (starts.size() == 1) return {std::move(starts.front())};
  const DiagnosisProblem& problem = plain.problem;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < starts.size() && !plain.cancelled(); ++i) {
    FitSummary at;
    at.parameters = starts[i].parameters;
    at.theta = starts[i].start;
    const disturbance::Linearisations linear =
        disturbance::linearise(problem.model, problem.data, at.parameters, at.theta);
    const double cost =
        prior_cost(at) + disturbance::estimate_noise(problem.model, problem.data, at.parameters,
                                                     at.theta, linear, noise, threads, kLastStep)
                             .minus_two_log_likelihood;
    if (!(cost < least)) continue;
    least = cost;
    best = i;
  }
  return {std::move(starts[best]), least};
}

std::vector<ParameterSubset> resonance_starts(const ParameterSubset& start) {
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
