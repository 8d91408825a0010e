#include "estimator/greybox/selection/search_round.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include "estimator/parallel.h"
#include "estimator/residual/diebold_mariano.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kQuickTolerance = 2e-3;
constexpr int kThoroughIterations = 15;
constexpr double kThoroughTolerance = 3e-5;
/// Candidates within this of the best are fitted to the end.
constexpr double kContender = 0.5;
constexpr std::size_t kMostContenders = 3;
/// At the noise floor the quick look is as good as the fit: what it does not expect is not there.
constexpr double kAtFloor = 1.05;
constexpr double kExpectable = 0.002;
/// Iterations for effects that come after one that explains the record.
constexpr int kGlimpseIterations = 4;
/// Then, other starts are tried only for effects within this factor of the best.
constexpr double kFar = 3.0;
/// After the first effect, that many of the most promising others are fitted.
constexpr std::size_t kLookedThrough = 9;
/// And that many are tried from other starts too.
constexpr std::size_t kAgain = 3;
constexpr std::size_t kAllStarts = 1000;
constexpr std::size_t kPairable = 5;
constexpr double kComparedBlock_s = 1.0;

FitOptions quick(const Workshop& shop) {
  FitOptions options;
  options.max_iterations = kQuickIterations;
  options.tolerance = kQuickTolerance;
  options.final_jacobian = false;
  options.cancel = shop.cancel;
  return options;
}

/// Tells the workshop how a round goes; from any thread.
class Reporter {
 public:
  Reporter(const Workshop& shop, int round, std::size_t tasks) : shop_(&shop) {
    begin_ = "round " + std::to_string(round) + ": ";
    progress_.of = static_cast<int>(tasks);
  }
  void looked(const std::string& effect) { tell("looking at " + effect, nullptr); }
  void expect(const std::vector<Glance>& glances) {
    const std::lock_guard lock(mutex_);
    for (const Glance& look : glances) progress_.expected.push_back(look.effect);
  }
  void tried(const Candidate& candidate) {
    tell("trying " + candidate.effects.front(), candidate.fitted_at_all ? &candidate : nullptr);
  }

 private:
  void tell(const std::string& doing, const Candidate* finished) {
    const std::lock_guard lock(mutex_);
    ++progress_.done;
    progress_.doing = begin_ + doing;
    if (finished != nullptr &&
        (progress_.best.empty() || finished->score_rms_m < progress_.best_rms_m)) {
      progress_.best = finished->effects.front();
      progress_.best_rms_m = finished->score_rms_m;
    }
    if (shop_->progress) shop_->progress(progress_);
  }

  const Workshop* shop_;
  std::string begin_;
  std::mutex mutex_;
  Progress progress_;
};

Candidate candidate_of(const Workshop& shop, const Stage& stage, const Glance& glance,
                       Trial trial) {
  Candidate candidate;
  candidate.effects = {glance.effect};
  candidate.expected_ratio = glance.expected_ratio;
  candidate.score_rms_m = trial.fitted.score_rms_m;
  candidate.fitted_at_all = true;
  candidate.p_value = chance(shop, stage.fitted, trial.fitted);
  candidate.fitted = std::move(trial.fitted);
  return candidate;
}

void sort_by_score(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    if (a.fitted_at_all != b.fitted_at_all) return a.fitted_at_all;
    return a.fitted_at_all ? a.score_rms_m < b.score_rms_m : a.expected_ratio < b.expected_ratio;
  });
}

}  // namespace

double chance(const Workshop& shop, const Fitted& earlier, const Fitted& later) {
  const auto scored = [&](const Fitted& fitted) {
    std::vector<double> series(fitted.residual_m.data(),
                               fitted.residual_m.data() + fitted.residual_m.size());
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (shop.evidence.scores[static_cast<Index>(i)] == 0.0) series[i] = std::nan("");
    }
    return series;
  };
  const int block =
      std::max(8, static_cast<int>(std::lround(kComparedBlock_s / shop.evidence.sample_time_s)));
  const estimator::residual::DieboldMarianoResult comparison =
      estimator::residual::diebold_mariano_test(scored(earlier), scored(later), block);
  if (!std::isfinite(comparison.p)) return 1.0;
  return comparison.z > 0.0 ? 0.5 * comparison.p : 1.0 - 0.5 * comparison.p;
}

Candidate tried(const Workshop& shop, const Stage& stage, const Glance& glance, int iterations) {
  FitOptions options = quick(shop);
  options.max_iterations = iterations;
  return candidate_of(shop, stage, glance, attempt(shop, glance, options));
}

void finish(const Workshop& shop, const Stage& stage, std::vector<Candidate>& candidates) {
  sort_by_score(candidates);
  if (candidates.empty()) return;
  const double best_m = candidates.front().score_rms_m;
  std::size_t contenders = 0;
  while (contenders < std::min(kMostContenders, candidates.size()) &&
         candidates[contenders].fitted_at_all &&
         candidates[contenders].score_rms_m <= (1.0 + kContender) * best_m &&
         candidates[contenders].score_rms_m <=
             (1.0 - 0.5 * kWorthwhile) * stage.fitted.score_rms_m) {
    ++contenders;
  }
  FitOptions options;
  options.max_iterations = kThoroughIterations;
  options.tolerance = kThoroughTolerance;
  options.cancel = shop.cancel;
  in_parallel(contenders, shop.threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    Fitted fitted = fit(shop.model, shop.evidence, shop.evidence.fits, candidate.fitted.searched,
                        candidate.fitted.x, options);
    if (fitted.fit_rms_m > candidate.fitted.fit_rms_m * (1.0 + 1e-3)) return;
    candidate.fitted = std::move(fitted);
    candidate.score_rms_m = candidate.fitted.score_rms_m;
    candidate.p_value = chance(shop, stage.fitted, candidate.fitted);
  });
  sort_by_score(candidates);
  for (std::size_t i = contenders; i < candidates.size(); ++i) {
    candidates[i].fitted.jacobian.resize(0, 0);  // large, and of no use any more
  }
}

Stage with(const Stage& stage, const Candidate& candidate) {
  Stage next = stage;
  next.added.insert(next.added.end(), candidate.effects.begin(), candidate.effects.end());
  next.fitted = candidate.fitted;
  return next;
}

Round single_round(const Workshop& shop, const Stage& stage, int number) {
  Round round;
  round.before = stage;
  std::vector<plant_sim::EffectInfo> effects;
  for (const plant_sim::EffectInfo& effect : shop.absent) {
    if (std::find(stage.added.begin(), stage.added.end(), effect.name) == stage.added.end()) {
      effects.push_back(effect);
    }
  }
  Reporter reporter(shop, number, 2 * effects.size());
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Glance> glances =
      glances_at(shop, stage, effects, [&](const std::string& effect) { reporter.looked(effect); });
  round.looked_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  reporter.expect(glances);
  const bool at_floor = stage.fitted.score_rms_m < kAtFloor * shop.evidence.noise_floor_m;
  round.candidates.resize(glances.size());
  std::atomic<bool> explained = false;
  const auto work = [&](std::size_t i, std::size_t first_start, std::size_t starts) {
    Glance look = glances[i];
    look.starts.erase(look.starts.begin(),
                      look.starts.begin() + static_cast<std::ptrdiff_t>(first_start));
    look.starts.resize(std::min(look.starts.size(), starts));
    if (shop.cancelled() || look.starts.empty()) return;
    FitOptions options = quick(shop);
    // once the record is explained, others only have to show whether they come near
    if (explained) options.max_iterations = kGlimpseIterations;
    Candidate found = candidate_of(shop, stage, look, attempt(shop, look, options));
    Candidate& candidate = round.candidates[i];
    if (!candidate.fitted_at_all || found.fitted.fit_rms_m < candidate.fitted.fit_rms_m) {
      candidate = std::move(found);
    }
    if (candidate.score_rms_m < kUnexplained * shop.evidence.noise_floor_m) explained = true;
  };
  in_parallel(glances.size(), shop.threads, [&](std::size_t i) {
    round.candidates[i].effects = {glances[i].effect};
    round.candidates[i].expected_ratio = glances[i].expected_ratio;
    const bool hopeless = (at_floor && glances[i].expected_ratio > 1.0 - kExpectable) ||
                          (!stage.added.empty() && i >= kLookedThrough);
    if (!hopeless) work(i, 0, 1);
    reporter.tried(round.candidates[i]);
  });
  double best_m = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : round.candidates) {
    best_m = std::min(best_m, candidate.score_rms_m);
  }
  in_parallel(glances.size(), shop.threads, [&](std::size_t i) {
    const Candidate& candidate = round.candidates[i];
    const bool far = explained && candidate.score_rms_m > kFar * best_m;
    // later stages have bent their parameters less
    const bool later = !stage.added.empty() && i >= kAgain;
    if (candidate.fitted_at_all && !far && !later) work(i, 1, kAllStarts);
  });
  finish(shop, stage, round.candidates);
  return round;
}

std::vector<Candidate> pair_round(const Workshop& shop, const Round& singles) {
  const std::size_t count = std::min(kPairable, singles.candidates.size());
  struct Pair {
    std::size_t first, second;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) pairs.push_back({i, k});
  }
  std::vector<Candidate> candidates(pairs.size());
  const auto base = static_cast<Index>(singles.before.fitted.searched.size());
  in_parallel(pairs.size(), shop.threads, [&](std::size_t i) {
    const Candidate& first = singles.candidates[pairs[i].first];
    const Candidate& second = singles.candidates[pairs[i].second];
    if (shop.cancelled() || !first.fitted_at_all || !second.fitted_at_all) return;
    Glance look;
    look.effect = first.effects.front();
    look.searched = first.fitted.searched;
    look.searched.insert(look.searched.end(), second.fitted.searched.begin() + base,
                         second.fitted.searched.end());
    VectorXd start(static_cast<Index>(look.searched.size()));
    start << first.fitted.x, second.fitted.x.tail(second.fitted.x.size() - base);
    look.starts = {start};
    candidates[i] = tried(shop, singles.before, look);
    candidates[i].effects.push_back(second.effects.front());
  });
  std::erase_if(candidates, [](const Candidate& c) { return !c.fitted_at_all; });
  finish(shop, singles.before, candidates);
  return candidates;
}

}  // namespace estimator::greybox::selection
