#include "estimator/greybox/selection/settled_trials.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/greybox/sensor_place.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

using disturbance::NoiseModel;

/// A start elsewhere is dropped where a first look finds it this far, in -2 log L, behind the
/// stage.
constexpr double kFirstLook = 600.0;
/// The same where it gains less than this share of what the best effect gains beside the stage.
constexpr double kHopefulShare = 0.5;
/// The share of what the best line gains: a line is exact at once, a start has yet to be fitted.
constexpr double kHopefulShareOfLine = 0.3;
/// Share of a resonance by which a fit moves it when the starts about it are to be tried again.
constexpr double kResonanceMoved = 0.03;

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
    (void)settle(std::move(starts), on_done);
  }

  void settle_elsewhere(double found_minus_two_log) {
    const double hopeless =
        std::min(stage_.minus_two_log + kFirstLook,
                 std::min(hopeless_by(found_minus_two_log), hopeless_by_best()));
    std::vector<PlacedStart> starts;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      for (const std::vector<ParameterSubset>& side : trials_[i].elsewhere)
        add_likeliest(i, side, stage_.noise, hopeless, starts);
    }
    std::vector<std::size_t> starts_of;
    for (const PlacedStart& start : starts) starts_of.push_back(start.trial);
    const std::vector<InnovationStage> reached = settle(std::move(starts), {});
    starts.clear();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const InnovationStage* const best = best_of(i, starts_of, reached);
      if (best == nullptr) continue;
      for (const std::vector<ParameterSubset>& side : trials_[i].elsewhere) {
        // shares and dampings of the side were judged at another resonance
        ModelStage there = with_values_of(side.front(), best->model.fitted);
        const bool out = is_out_of_range(*best);
        if (out || has_moved(side.front(), there.fitted))
          add_likeliest(i, mass_share_starts(plain_, there), best->noise, hopeless, starts);
      }
    }
    (void)settle(std::move(starts), {});
    in_parallel(trials_.size(), plain_.options.threads, [&](std::size_t i) {
      if (trials_[i].elsewhere.empty() || !(best_[i].minus_two_log < hopeless)) return;
      // where the force acts shows once the resonance is found
      take_better(i, settled(plain_, best_[i].model, with_force_on_other_mass(best_[i]),
                             Settling::once, SimulationWidth{}));
    });
  }

  [[nodiscard]] std::vector<InnovationStage> best() && { return std::move(best_); }

 private:
  void add_likeliest(std::size_t trial, const std::vector<ParameterSubset>& side,
                     const NoiseModel& noise, double hopeless, std::vector<PlacedStart>& starts) {
    LikeliestStart likeliest =
        likeliest_start(plain_, side, noise, plain_.options.threads, hopeless);
    if (!(likeliest.minus_two_log < stage_.minus_two_log)) return;
    starts.push_back({trial,
                      model_at(trials_[trial].starts.front().added, std::move(likeliest.start)),
                      std::move(likeliest.noise)});
  }

  /// The likeliest stage of a trial, in its range or not; null: none.
  [[nodiscard]] static const InnovationStage* best_of(std::size_t trial,
                                                      const std::vector<std::size_t>& trials,
                                                      const std::vector<InnovationStage>& reached) {
    const InnovationStage* best = nullptr;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      if (trials[k] != trial || !std::isfinite(reached[k].minus_two_log)) continue;
      if (best == nullptr || reached[k].minus_two_log < best->minus_two_log) best = &reached[k];
    }
    return best;
  }

  /// A start with the values that a fit gives to its parameters.
  [[nodiscard]] static ModelStage with_values_of(const ParameterSubset& start,
                                                 const FitSummary& fitted) {
    ModelStage model;
    model.fitted.parameters = start.parameters;
    model.fitted.theta = start.start;
    take_values(fitted, model.fitted);
    return model;
  }

  [[nodiscard]] static bool has_moved(const ParameterSubset& start, const FitSummary& to) {
    FitSummary from;
    from.parameters = start.parameters;
    from.theta = start.start;
    const double from_Hz = from.value(kSecondMassResonance);
    return std::abs(to.value(kSecondMassResonance) - from_Hz) > kResonanceMoved * from_Hz;
  }

  /// Settles all starts at once, as some trials have several times as many as others.
  std::vector<InnovationStage> settle(std::vector<PlacedStart> starts,
                                      const std::function<void(std::size_t)>& on_done) {
    std::vector<InnovationStage> reached(starts.size());
    std::vector<std::size_t> left(trials_.size(), 0);
    for (const PlacedStart& start : starts) ++left[start.trial];
    std::mutex counting;
    in_parallel(starts.size(), plain_.options.threads, [&](std::size_t k) {
      PlacedStart& start = starts[k];
      if (!is_line(trials_[start.trial]))
        start.noise = with_likelier_sites(plain_, start.model, std::move(start.noise));
      reached[k] =
          settled(plain_, std::move(start.model), start.noise, Settling::once, SimulationWidth{});
      const std::lock_guard lock(counting);
      if (--left[start.trial] == 0 && on_done && !plain_.cancelled()) on_done(start.trial);
    });
    for (std::size_t k = 0; k < starts.size(); ++k) take_better(starts[k].trial, reached[k]);
    return reached;
  }

  /// Takes a stage where it is better than the trial's best. An optimum beyond the effect's range,
  /// which no search takes, hides none within it.
  void take_better(std::size_t i, InnovationStage one) {
    InnovationStage& best = best_[i];
    bool better = one.minus_two_log < best.minus_two_log;
    if (std::isfinite(best.minus_two_log) && std::isfinite(one.minus_two_log) &&
        !trials_[i].elsewhere.empty()) {
      const bool out = is_out_of_range(one);
      if (out != is_out_of_range(best)) better = !out;
    }
    if (better) best = std::move(one);
  }

  [[nodiscard]] bool is_out_of_range(const InnovationStage& one) const {
    return std::isfinite(one.minus_two_log) &&
           leaves_its_range(one.model.fitted, stage_.model.fitted.parameters.size());
  }

  [[nodiscard]] double hopeless_by(double minus_two_log, double share = kHopefulShare) const {
    if (!(minus_two_log < stage_.minus_two_log)) return std::numeric_limits<double>::infinity();
    return stage_.minus_two_log - share * (stage_.minus_two_log - minus_two_log);
  }

  [[nodiscard]] double hopeless_by_best() const {
    double hopeless = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      if (is_out_of_range(best_[i])) continue;  // no search takes it
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

std::vector<InnovationStage> settle_trials(const SearchContext& plain, const InnovationStage& stage,
                                           std::span<const InnovationTrial> trials,
                                           const std::function<void(std::size_t trial)>& on_done,
                                           double found_minus_two_log) {
  SettledTrials all(plain, stage, trials);
  all.settle_starts(on_done);
  all.settle_elsewhere(found_minus_two_log);
  return std::move(all).best();
}

}  // namespace estimator::greybox::selection
