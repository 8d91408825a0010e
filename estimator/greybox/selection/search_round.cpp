#include "estimator/greybox/selection/search_round.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/model_refinements.h"
#include "estimator/parallel.h"
#include "estimator/residual/diebold_mariano.h"

namespace estimator::greybox::selection {
namespace {

/// Shift of the parameters, in prior widths, above which an explanation is implausible.
constexpr double kStrain = 6.0;

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kRoundTolerance = 2e-3;
constexpr int kThoroughIterations = 15;
constexpr double kThoroughTolerance = 3e-5;
/// Ratio within which candidates are fitted to convergence.
constexpr double kContender = 0.5;
constexpr std::size_t kMostContenders = 3;
/// At the noise floor the screening is as reliable as the fit: effects it rejects are absent.
constexpr double kAtFloor = 1.05;
constexpr double kExpectable = 0.002;
/// Iterations for effects after one that explains the record.
constexpr int kGlimpseIterations = 4;
/// Ratio to the best within which other starts are tried then.
constexpr double kFar = 3.0;
/// Number of further effects that are fitted after the first one was added.
constexpr std::size_t kLookedThrough = 9;
/// Number of these that are tried from other starts.
constexpr std::size_t kAgain = 3;
constexpr std::size_t kAllStarts = 1000;
/// Fitted side by side before it is asked whether one explains the record: a number of its own, so
/// that the answer does not depend on the threads.
constexpr std::size_t kWave = 4;
constexpr std::size_t kPairable = 5;
constexpr double kComparedBlock_s = 1.0;

FitOptions quick(const SearchContext& context) {
  FitOptions options;
  options.max_iterations = kQuickIterations;
  options.tolerance = kRoundTolerance;
  options.final_jacobian = false;
  options.cancel = context.options.cancel;
  return options;
}

/// Reports the progress of a round; thread-safe.
class Reporter {
 public:
  Reporter(const SearchContext& context, int round, std::size_t tasks) : context_(&context) {
    progress_.round = round;
    progress_.of = static_cast<int>(tasks);
  }
  void on_screened(const std::string& effect) { report(effect, true, nullptr); }
  void expect(const std::vector<ScreeningResult>& screened) {
    const std::lock_guard lock(mutex_);
    for (const ScreeningResult& one : screened) progress_.expected.push_back(one.effect);
  }
  void on_fitted(const Candidate& candidate) {
    report(candidate.effects.front(), false, candidate.fitted_at_all ? &candidate : nullptr);
  }

 private:
  void report(const std::string& effect, bool screening, const Candidate* finished) {
    const std::lock_guard lock(mutex_);
    ++progress_.done;
    progress_.effect = effect;
    progress_.screening = screening;
    if (finished != nullptr &&
        (progress_.best.empty() || finished->validation_rms_m < progress_.best_rms_m)) {
      progress_.best = finished->effects.front();
      progress_.best_rms_m = finished->validation_rms_m;
    }
    if (context_->options.progress) context_->options.progress(progress_);
  }

  const SearchContext* context_;
  std::mutex mutex_;
  SearchProgress progress_;
};

Candidate candidate_of(const SearchContext& context, const ModelStage& stage,
                       const ScreeningResult& screened, RefinedCandidate trial) {
  Candidate candidate;
  candidate.effects = {screened.effect};
  candidate.expected_ratio = screened.expected_ratio;
  candidate.validation_rms_m = trial.fitted.validation_rms_m;
  candidate.fitted_at_all = true;
  candidate.p_value = chance(context, stage.fitted, trial.fitted);
  candidate.fitted = std::move(trial.fitted);
  return candidate;
}

}  // namespace

void sort_by_score(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    if (a.fitted_at_all != b.fitted_at_all) return a.fitted_at_all;
    return a.fitted_at_all ? a.validation_rms_m < b.validation_rms_m
                           : a.expected_ratio < b.expected_ratio;
  });
}

double chance(const SearchContext& context, const FitSummary& earlier, const FitSummary& later) {
  const auto scored = [&](const FitSummary& fitted) {
    std::vector<double> series(fitted.residual_m.data(),
                               fitted.residual_m.data() + fitted.residual_m.size());
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (context.problem.data.validation_mask[static_cast<Index>(i)] == 0.0)
        series[i] = std::nan("");
    }
    return series;
  };
  const int block = std::max(
      8, static_cast<int>(std::lround(kComparedBlock_s / context.problem.data.sample_time_s)));
  const estimator::residual::DieboldMarianoResult comparison =
      estimator::residual::diebold_mariano_test(scored(earlier), scored(later), block);
  if (!std::isfinite(comparison.p)) return 1.0;
  return comparison.z > 0.0 ? 0.5 * comparison.p : 1.0 - 0.5 * comparison.p;
}

Candidate quick_fit(const SearchContext& context, const ModelStage& stage,
                    const ScreeningResult& screened, int iterations) {
  FitOptions options = quick(context);
  options.max_iterations = iterations;
  return candidate_of(context, stage, screened, refine(context, screened, options));
}

namespace {

/// Starts about a fitted resonance: neighbouring frequencies, each with a damping of its own, are
/// minima of their own where the motion hardly excites it. `first`: the effect's first parameter.
/// Empty for other effects.
std::vector<VectorXd> resonance_restarts(const FitSummary& fitted, std::size_t first) {
  const auto index_of = [&](std::string_view ending) {
    for (std::size_t i = first; i < fitted.parameters.size(); ++i) {
      if (fitted.parameters[i].name.ends_with(ending)) return static_cast<Index>(i);
    }
    return Index{-1};
  };
  const Index frequency = index_of(".resonance_Hz");
  const Index damping = index_of(".damping_ratio");
  std::vector<VectorXd> starts;
  if (frequency < 0 || damping < 0) return starts;
  const FreeParameter& tuned = fitted.parameters[static_cast<std::size_t>(frequency)];
  const FreeParameter& damped = fitted.parameters[static_cast<std::size_t>(damping)];
  const double found_Hz = tuned.to_physical(fitted.theta[frequency]);
  for (const double ratio : {0.3, 0.6, 0.8, 0.92, 1.08, 1.25, 1.6, 3.0}) {
    VectorXd start = fitted.theta;
    start[frequency] = std::clamp(tuned.to_theta(ratio * found_Hz), tuned.lower, tuned.upper);
    start[damping] = std::clamp(damped.to_theta(0.03), damped.lower, damped.upper);
    starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace

void refine_best(const SearchContext& context, const ModelStage& stage,
                 std::vector<Candidate>& candidates) {
  sort_by_score(candidates);
  if (candidates.empty()) return;
  const double best_m = candidates.front().validation_rms_m;
  std::size_t contenders = 0;
  while (contenders < std::min(kMostContenders, candidates.size()) &&
         candidates[contenders].fitted_at_all &&
         candidates[contenders].validation_rms_m <= (1.0 + kContender) * best_m &&
         candidates[contenders].validation_rms_m <=
             (1.0 - 0.5 * kWorthwhile) * stage.fitted.validation_rms_m) {
    ++contenders;
  }
  FitOptions options;
  options.max_iterations = kThoroughIterations;
  options.tolerance = kThoroughTolerance;
  options.cancel = context.options.cancel;
  in_parallel(contenders, context.options.threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    FitSummary fitted =
        fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
            candidate.fitted.parameters, candidate.fitted.theta, options);
    for (const VectorXd& start : resonance_restarts(fitted, stage.fitted.parameters.size())) {
      FitSummary other =
          fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
              candidate.fitted.parameters, start, options);
      if (other.training_rms_m < fitted.training_rms_m) fitted = std::move(other);
    }
    if (fitted.training_rms_m > candidate.fitted.training_rms_m * (1.0 + 1e-3)) return;
    candidate.fitted = std::move(fitted);
    candidate.validation_rms_m = candidate.fitted.validation_rms_m;
    candidate.p_value = chance(context, stage.fitted, candidate.fitted);
  });
  sort_by_score(candidates);
  for (std::size_t i = contenders; i < candidates.size(); ++i) {
    candidates[i].fitted.jacobian.resize(0, 0);  // large and no longer needed
  }
}

ModelStage with(const ModelStage& stage, const Candidate& candidate) {
  ModelStage next = stage;
  next.added.insert(next.added.end(), candidate.effects.begin(), candidate.effects.end());
  next.fitted = candidate.fitted;
  return next;
}

Round single_round(const SearchContext& context, const ModelStage& stage, int number,
                   double within_m) {
  Round round;
  round.before = stage;
  std::vector<plant_sim::EffectInfo> effects;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (std::find(stage.added.begin(), stage.added.end(), effect.name) == stage.added.end()) {
      effects.push_back(effect);
    }
  }
  Reporter reporter(context, number, 2 * effects.size());
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<ScreeningResult> screened = screen(
      context, stage, effects, [&](const std::string& effect) { reporter.on_screened(effect); });
  round.screening_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double promised_m =
      screened.empty() ? 0.0 : screened.front().expected_ratio * stage.fitted.training_rms_m;
  if (screened.empty() || promised_m > within_m) {
    return round;
  }
  reporter.expect(screened);
  const bool at_floor =
      stage.fitted.validation_rms_m < kAtFloor * context.problem.data.noise_floor_m;
  round.candidates.resize(screened.size());
  bool explained = false;
  const auto work = [&](std::size_t i, std::size_t first_start, std::size_t starts) {
    ScreeningResult result = screened[i];
    result.starts.erase(result.starts.begin(),
                        result.starts.begin() + static_cast<std::ptrdiff_t>(first_start));
    result.starts.resize(std::min(result.starts.size(), starts));
    if (context.cancelled() || result.starts.empty()) return;
    FitOptions options = quick(context);
    // once the record is explained, others only have to show whether they come near
    if (explained) options.max_iterations = kGlimpseIterations;
    Candidate found = candidate_of(context, stage, result, refine(context, result, options));
    Candidate& candidate = round.candidates[i];
    if (!candidate.fitted_at_all || found.fitted.training_rms_m < candidate.fitted.training_rms_m) {
      candidate = std::move(found);
    }
  };
  for (std::size_t from = 0; from < screened.size(); from += kWave) {
    const std::size_t count = std::min(kWave, screened.size() - from);
    in_parallel(count, context.options.threads, [&](std::size_t k) {
      const std::size_t i = from + k;
      round.candidates[i].effects = {screened[i].effect};
      round.candidates[i].expected_ratio = screened[i].expected_ratio;
      const bool hopeless = (at_floor && screened[i].expected_ratio > 1.0 - kExpectable) ||
                            (!stage.added.empty() && i >= kLookedThrough);
      if (!hopeless) work(i, 0, 1);
      reporter.on_fitted(round.candidates[i]);
    });
    explained = std::any_of(round.candidates.begin(), round.candidates.end(), [&](const auto& c) {
      return c.fitted_at_all &&
             c.validation_rms_m < kUnexplained * context.problem.data.noise_floor_m;
    });
  }
  double best_m = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : round.candidates) {
    best_m = std::min(best_m, candidate.validation_rms_m);
  }
  in_parallel(screened.size(), context.options.threads, [&](std::size_t i) {
    const Candidate& candidate = round.candidates[i];
    const bool far = explained && candidate.validation_rms_m > kFar * best_m;
    // later stages depend less on the start
    const bool later = !stage.added.empty() && i >= kAgain;
    if (candidate.fitted_at_all && !far && !later) work(i, 1, kAllStarts);
  });
  if (!explained && stage.added.empty()) refit_model_refinements(context, stage, round.candidates);
  refine_best(context, stage, round.candidates);
  return round;
}

std::vector<Candidate> pair_round(const SearchContext& context, const Round& singles) {
  const std::size_t count = std::min(kPairable, singles.candidates.size());
  struct Pair {
    std::size_t first, second;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) pairs.push_back({i, k});
  }
  std::vector<Candidate> candidates(pairs.size());
  const auto base = static_cast<Index>(singles.before.fitted.parameters.size());
  in_parallel(pairs.size(), context.options.threads, [&](std::size_t i) {
    const Candidate& first = singles.candidates[pairs[i].first];
    const Candidate& second = singles.candidates[pairs[i].second];
    if (context.cancelled() || !first.fitted_at_all || !second.fitted_at_all) return;
    ScreeningResult screened;
    screened.effect = first.effects.front();
    ParameterSubset start{first.fitted.parameters, first.fitted.theta};
    append(start, {{second.fitted.parameters.begin() + base, second.fitted.parameters.end()},
                   second.fitted.theta.tail(second.fitted.theta.size() - base)});
    screened.starts = {std::move(start)};
    candidates[i] = quick_fit(context, singles.before, screened);
    candidates[i].effects.push_back(second.effects.front());
  });
  std::erase_if(candidates, [](const Candidate& c) { return !c.fitted_at_all; });
  refine_best(context, singles.before, candidates);
  return candidates;
}

namespace {

/// Fall of the log likelihood of the held-out data per further parameter that tells nothing, also
/// where it is consistent: a parameter that only follows another effect's.
constexpr double kIdle_nats = 2.0;

/// True where the held-out data do not show that a candidate does worse than the best for having
/// fewer parameters.
bool does_as_well(const SearchContext& context, const Candidate& other, const Candidate& best) {
  const double further =
      static_cast<double>(best.fitted.parameters.size() - other.fitted.parameters.size());
  const double lost_nats = context.problem.data.validation_mask.sum() *
                           std::log(other.validation_rms_m / best.validation_rms_m);
  return lost_nats < kIdle_nats * further || chance(context, other.fitted, best.fitted) > kChance;
}

}  // namespace

const Candidate& simplest(const SearchContext& context, const std::vector<Candidate>& candidates) {
  const Candidate& best = candidates.front();
  const Candidate* chosen = &best;
  for (const Candidate& other : candidates) {
    if (!other.fitted_at_all || other.effects.size() > chosen->effects.size()) continue;
    if (other.fitted.parameters.size() < chosen->fitted.parameters.size() &&
        prior_cost(other.fitted) < prior_cost(best.fitted) + kStrain &&
        other.validation_rms_m <
            (1.0 + worthwhile_at(context, other.validation_rms_m)) * best.validation_rms_m &&
        does_as_well(context, other, best)) {
      chosen = &other;
    }
  }
  return *chosen;
}

}  // namespace estimator::greybox::selection
