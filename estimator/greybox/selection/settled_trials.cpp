#include "estimator/greybox/selection/settled_trials.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

using disturbance::NoiseModel;

/// Lag in -2 log L behind the stage at which a first look at a start elsewhere leaves hope, and the
/// share of what the best trial gains that it has to gain: of a line's less, which is exact at
/// once.
constexpr double kFirstLook = 600.0;
constexpr double kHopefulShare = 0.5;
constexpr double kHopefulShareOfLine = 0.3;

/// The lines at the sites where the model makes them likeliest: one that lacks an effect may have
/// put them where they make up for it.
NoiseModel with_likelier_sites(const SearchContext& plain, const ModelStage& start,
                               NoiseModel noise) {
  if (noise.lines.empty() || plain.cancelled()) return noise;
  const plant_sim::ModelFile& model = plain.problem.model;
  const FitDataset& data = plain.problem.data;
  const FitSummary& at = start.fitted;
  const disturbance::Linearisations linear =
      disturbance::linearise(model, data, at.parameters, at.theta, noise.force_place);
  const auto cost = [&](const NoiseModel& tried) {
    return disturbance::minus_two_log_likelihood(model, data, at.parameters, at.theta, linear,
                                                 tried);
  };
  double least = cost(noise);
  for (std::size_t i = 0; i < noise.lines.size(); ++i) {
    for (const disturbance::LineSite site : disturbance::sites_of(linear.front())) {
      if (site == noise.lines[i].site) continue;
      NoiseModel other = moved(noise, i, site);
      const double now = cost(other);
      if (!(now < least)) continue;
      least = now;
      noise = std::move(other);
    }
  }
  return noise;
}

/// A start of a trial with its noise model.
struct PlacedStart {
  std::size_t trial;
  ModelStage model;
  NoiseModel noise;
};

bool is_line(const InnovationTrial& trial) { return trial.candidate.effect.empty(); }

class SettledTrials {
 public:
  SettledTrials(const SearchContext& plain, const InnovationStage& stage,
                std::span<const InnovationTrial> trials)
      : plain_(plain), stage_(stage), trials_(trials), best_(trials.size()) {}

  void settle_starts(const std::function<void(std::size_t)>& on_done) {
    std::vector<PlacedStart> starts;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const InnovationTrial& trial = trials_[i];
      NoiseModel noise = stage_.noise;
      if (is_line(trial)) noise.lines.push_back(trial.candidate.line);
      for (const ModelStage& start : trial.starts) {
        if (trial.simulated || trial.candidate.gain_nats > 0.0) starts.push_back({i, start, noise});
      }
    }
    settle(std::move(starts), on_done);
  }

  void settle_elsewhere(double found_minus_two_log) {
    const double hopeless =
        std::min(stage_.minus_two_log + kFirstLook,
                 std::min(hopeless_by(found_minus_two_log), hopeless_by_best()));
    std::vector<PlacedStart> starts;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      for (const std::vector<ParameterSubset>& side : trials_[i].elsewhere) {
        LikeliestStart likeliest =
            likeliest_start(plain_, side, stage_.noise, plain_.options.threads, hopeless);
        if (!(likeliest.minus_two_log < stage_.minus_two_log)) continue;
        ModelStage start{trials_[i].starts.front().added, {}};
        start.fitted.parameters = std::move(likeliest.start.parameters);
        start.fitted.theta = std::move(likeliest.start.start);
        starts.push_back({i, std::move(start), std::move(likeliest.noise)});
      }
    }
    settle(std::move(starts), {});
    in_parallel(trials_.size(), plain_.options.threads, [&](std::size_t i) {
      if (trials_[i].elsewhere.empty() || !(best_[i].minus_two_log < hopeless)) return;
      // where the force acts shows once the resonance is found
      take_better(i, selection::settled(plain_, best_[i].model, with_force_on_other_mass(best_[i]),
                                        1, SimulationWidth{}));
    });
  }

  [[nodiscard]] std::vector<InnovationStage> best() && { return std::move(best_); }

 private:
  /// All starts at once: some trials have several times as many as others.
  void settle(std::vector<PlacedStart> starts, const std::function<void(std::size_t)>& on_done) {
    std::vector<InnovationStage> reached(starts.size());
    std::vector<std::size_t> left(trials_.size(), 0);
    for (const PlacedStart& start : starts) ++left[start.trial];
    std::mutex counting;
    in_parallel(starts.size(), plain_.options.threads, [&](std::size_t k) {
      PlacedStart& start = starts[k];
      if (!is_line(trials_[start.trial]))
        start.noise = with_likelier_sites(plain_, start.model, std::move(start.noise));
      reached[k] =
          selection::settled(plain_, std::move(start.model), start.noise, 1, SimulationWidth{});
      const std::lock_guard lock(counting);
      if (--left[start.trial] == 0 && on_done && !plain_.cancelled()) on_done(start.trial);
    });
    for (std::size_t k = 0; k < starts.size(); ++k)
      take_better(starts[k].trial, std::move(reached[k]));
  }

  /// Takes a stage where it is better than the trial's best. An optimum beyond the effect's range,
  /// which no search takes, hides none within it.
  void take_better(std::size_t i, InnovationStage one) {
    InnovationStage& best = best_[i];
    const std::size_t before = stage_.model.fitted.parameters.size();
    bool better = one.minus_two_log < best.minus_two_log;
    if (std::isfinite(best.minus_two_log) && std::isfinite(one.minus_two_log) &&
        !trials_[i].elsewhere.empty()) {
      const bool out = leaves_its_range(one.model.fitted, before);
      if (out != leaves_its_range(best.model.fitted, before)) better = !out;
    }
    if (better) best = std::move(one);
  }

  [[nodiscard]] double hopeless_by(double minus_two_log, double share = kHopefulShare) const {
    if (!(minus_two_log < stage_.minus_two_log)) return std::numeric_limits<double>::infinity();
    return stage_.minus_two_log - share * (stage_.minus_two_log - minus_two_log);
  }

  [[nodiscard]] double hopeless_by_best() const {
    double hopeless = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const double share = is_line(trials_[i]) ? kHopefulShareOfLine : kHopefulShare;
      hopeless = std::min(hopeless, hopeless_by(best_[i].minus_two_log, share));
    }
    return hopeless;
  }

  const SearchContext& plain_;
  const InnovationStage& stage_;
  std::span<const InnovationTrial> trials_;
  std::vector<InnovationStage> best_;
};

}  // namespace

std::vector<InnovationStage> settled(const SearchContext& plain, const InnovationStage& stage,
                                     std::span<const InnovationTrial> trials,
                                     double found_minus_two_log,
                                     const std::function<void(std::size_t trial)>& on_done) {
  SettledTrials all(plain, stage, trials);
  all.settle_starts(on_done);
  all.settle_elsewhere(found_minus_two_log);
  return std::move(all).best();
}

}  // namespace estimator::greybox::selection
