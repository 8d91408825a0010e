#include "estimator/greybox/selection/likeliest_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/sensor_place.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

constexpr double kTriedShares[] = {0.15, 0.3, 0.6};
constexpr double kTriedDamping_ratio = 0.02;
/// Fall of -2 log L below which a step of a noise model's search is the last: where many starts are
/// told apart, among those that are followed, and among the likeliest.
constexpr double kGridAlone = std::numeric_limits<double>::infinity();
constexpr double kRoughStep = 100.0;
constexpr double kLastStep = 1.0;
constexpr std::size_t kFollowed = 6;
constexpr std::size_t kFinalists = 3;

/// True where the model at these values has a second mass.
bool has_swing(const plant_sim::ModelFile& model, const FitSummary& at) {
  return has_second_mass(*disturbance::model_ensemble(model, model.step_s, at.parameters, at.theta),
                         0);
}

/// A start with the noise model that is searched for it.
struct Tried {
  std::size_t start;
  FitSummary at;
  disturbance::NoiseModel noise;
  double minus_two_log = std::numeric_limits<double>::infinity();

  void search_noise(const DiagnosisProblem& problem, unsigned threads, double enough) {
    const disturbance::Linearisations linear = disturbance::linearise(
        problem.model, problem.data, at.parameters, at.theta, noise.force_place);
    disturbance::NoiseEstimate found = disturbance::estimate_noise(
        problem.model, problem.data, at.parameters, at.theta, linear, noise, threads, enough);
    noise = std::move(found.noise);
    minus_two_log = prior_cost(at) + found.minus_two_log_likelihood;
  }
};

disturbance::NoiseModel on_place(disturbance::NoiseModel noise, double force_place) {
  noise.force_place = force_place;
  return noise;
}

}  // namespace

LikeliestStart likeliest_start(const SearchContext& plain, std::vector<ParameterSubset> starts,
                               const disturbance::NoiseModel& noise, unsigned threads,
                               double hopeless_minus_two_log) {
  const DiagnosisProblem& problem = plain.problem;
  std::vector<Tried> all;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    FitSummary at;
    at.parameters = starts[i].parameters;
    at.theta = starts[i].start;
    if (has_swing(problem.model, at)) {
      for (const double place : {0.0, 1.0}) all.push_back(Tried{i, at, on_place(noise, place)});
    } else if (starts.size() > 1) {
      all.push_back(Tried{i, at, noise});
    }
  }
  const auto search_noise = [&](double enough) {
    // the first search of noise models goes several ways at once; many of them share the threads
    const unsigned own = all.size() == 1 ? threads : 1;
    in_parallel(all.size(), threads, [&](std::size_t k) {
      if (!plain.cancelled()) all[k].search_noise(problem, own, enough);
    });
    std::stable_sort(all.begin(), all.end(), [](const Tried& a, const Tried& b) {
      return a.minus_two_log < b.minus_two_log;
    });
  };
  if (all.size() > kFinalists) {
    search_noise(kGridAlone);
    std::erase_if(all,
                  [&](const Tried& one) { return !(one.minus_two_log < hopeless_minus_two_log); });
    all.resize(std::min(all.size(), kFollowed));
    if (all.size() > kFinalists) {
      search_noise(kRoughStep);
      all.resize(kFinalists);
    }
  }
  search_noise(kLastStep);
  LikeliestStart best;
  best.noise = noise;
  std::size_t chosen = 0;
  if (!all.empty() && std::isfinite(all.front().minus_two_log)) {
    chosen = all.front().start;
    best.minus_two_log = all.front().minus_two_log;
    best.noise = std::move(all.front().noise);
  }
  best.start = std::move(starts[chosen]);
  return best;
}

ModelStage model_at(std::vector<std::string> added, ParameterSubset start) {
  ModelStage model{std::move(added), {}};
  model.fitted.parameters = std::move(start.parameters);
  model.fitted.theta = std::move(start.start);
  return model;
}

std::vector<ParameterSubset> mass_share_starts(const SearchContext& context,
                                               const ModelStage& model) {
  const std::vector<FreeParameter>& parameters = model.fitted.parameters;
  if (!std::isfinite(model.fitted.value(kSecondMassResonance))) return {};
  std::vector<ParameterSubset> starts;
  for (const Eigen::VectorXd& values : {model.fitted.theta, with_file_values(context, model)}) {
    for (const double share : kTriedShares) {
      ParameterSubset& with = starts.emplace_back(ParameterSubset{parameters, values});
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        const FreeParameter& p = parameters[i];
        double& theta = with.start[static_cast<Eigen::Index>(i)];
        if (p.name == "second_mass.mass_ratio") theta = p.to_theta(share);
        if (p.name == "second_mass.damping_ratio") theta = p.to_theta(kTriedDamping_ratio);
        if (p.name == kSecondMassSensorRatio) theta = p.to_theta(1.0);
        theta = std::clamp(theta, p.lower, p.upper);
      }
    }
  }
  return starts;
}

}  // namespace estimator::greybox::selection
