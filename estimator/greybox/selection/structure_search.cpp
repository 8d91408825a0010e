#include "estimator/greybox/selection/structure_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "estimator/greybox/selection/backward_elimination.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/pair_search.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/selection_path.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostEffects = 4;
/// One after another; when these do not explain the record, two at once are tried before any more.
constexpr std::size_t kBeforeTwoAtOnce = 2;
/// Of the first round, that many are tried as the first effect when the best leads nowhere.
constexpr std::size_t kDetours = 3;
/// They have to leave less than this share of the error, and by another way than the best: two
/// effects together may look like a third one, which then comes far before either.
constexpr double kHelpful = 0.7;
/// And what is left must be this many times the noise.
constexpr double kLost = 2.0;
constexpr double kSamePath = 0.1;
/// A gain must also be more than chance, unless it is a large one.
constexpr double kChance = 0.01;
constexpr double kLargeGain = 0.1;
/// Of the parameters, more than between two explanations that are alike.
constexpr double kStrain = 6.0;

/// Whether the effect wants to be larger, or a wave longer, than such an effect can be: then it
/// stands for something else.
bool leaves_its_range(const Stage& stage, const Candidate& candidate) {
  const Fitted& fitted = candidate.fitted;
  for (std::size_t i = stage.fitted.searched.size(); i < fitted.searched.size(); ++i) {
    const SearchParameter& p = fitted.searched[i];
    const bool is_angle = p.name.find(".phase_rad") != std::string::npos;
    const bool absent = fitted.x[static_cast<Eigen::Index>(i)] == 0.0;
    if (p.refinement == 0 && fitted.at_bound[i] != 0 && !absent && !is_angle) return true;
  }
  return false;
}

bool is_gain(const Workshop& shop, const Stage& stage, const Candidate& candidate) {
  const double worthwhile = worthwhile_at(shop, stage.fitted.score_rms_m);
  const double gain = 1.0 - candidate.score_rms_m / stage.fitted.score_rms_m;
  const double fit_gain = 1.0 - candidate.fitted.fit_rms_m / stage.fitted.fit_rms_m;
  const double enough = worthwhile * static_cast<double>(candidate.effects.size());
  // chance: steadily better wherever it was scored, or as much better where it was fitted
  return candidate.fitted_at_all && gain > enough && !leaves_its_range(stage, candidate) &&
         (gain > kLargeGain || candidate.p_value < kChance || fit_gain > enough);
}

/// How far the parameters have gone from what was expected of them, in squared standard deviations.
double strain(const Fitted& fitted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fitted.searched.size(); ++i) {
    const SearchParameter& p = fitted.searched[i];
    const double off = (fitted.x[static_cast<Eigen::Index>(i)] - p.prior_mean) / p.prior_sd;
    if (std::isfinite(off)) sum += off * off;
  }
  return sum;
}

/// Of candidates that explain the record alike, the one with the fewest parameters; not one that
/// needs the plant to be another than was expected.
const Candidate& simplest(const Workshop& shop, const std::vector<Candidate>& candidates) {
  const Candidate* chosen = &candidates.front();
  for (const Candidate& other : candidates) {
    if (!other.fitted_at_all || other.effects.size() > chosen->effects.size()) continue;
    if (other.fitted.searched.size() < chosen->fitted.searched.size() &&
        strain(other.fitted) < strain(candidates.front().fitted) + kStrain &&
        other.score_rms_m <
            (1.0 + worthwhile_at(shop, other.score_rms_m)) * candidates.front().score_rms_m &&
        chance(shop, other.fitted, candidates.front().fitted) > kChance) {
      chosen = &other;
    }
  }
  return *chosen;
}

/// Rounds from a stage until it has `most` effects or nothing helps any more: then false.
bool go_on(const Workshop& shop, Stage& stage, std::vector<Round>& rounds, bool pairs_too,
           std::size_t most = kMostEffects) {
  while (stage.added.size() < most && !shop.cancelled()) {
    Round round = single_round(shop, stage, static_cast<int>(rounds.size()) + 1);
    if (round.candidates.empty()) return false;
    // those that cannot be taken go behind those that can
    std::stable_partition(
        round.candidates.begin(), round.candidates.end(),
        [&](const Candidate& candidate) { return is_gain(shop, stage, candidate); });
    const bool single = is_gain(shop, stage, round.candidates.front());
    if (pairs_too && !single && !is_explained(shop, stage) && !shop.cancelled()) {
      std::vector<Candidate> pairs = pair_round(shop, round);
      if (!pairs.empty() && is_gain(shop, stage, pairs.front())) {
        round.candidates.insert(round.candidates.begin(), pairs.front());
      }
    }
    const bool gain = is_gain(shop, stage, round.candidates.front());
    if (gain) {
      stage = with(stage, simplest(shop, round.candidates));
      if (stage.fitted.jacobian.size() == 0) {
        stage.fitted = finished(shop, stage.fitted);
      }
    }
    rounds.push_back(std::move(round));
    if (!gain) return false;
  }
  return true;
}

/// A search from the first stage to where nothing helped any more.
struct Trodden {
  Stage stage;
  std::vector<Round> rounds;
};

/// The search from `first` with a candidate as its beginning, after the round `begun`.
Trodden trodden_from(const Workshop& shop, const Stage& first, const Candidate& candidate,
                     const Round& begun) {
  Trodden other{with(first, candidate), {begun}};
  end_unhindered(shop, other.stage);
  go_on(shop, other.stage, other.rounds, false);
  look_over(shop, other.stage, Look::on_the_way);
  if (candidate.effects.size() > 1) {
    auto& candidates = other.rounds.front().candidates;
    candidates.insert(candidates.begin(), candidate);
  }
  return other;
}

bool leads_further(const Trodden& other, const Trodden& best) {
  return other.stage.fitted.score_rms_m < (1.0 - kRivals) * best.stage.fitted.score_rms_m;
}

/// Two effects together as the beginning, where one after another has not explained the record.
std::optional<Trodden> start_with_two(const Workshop& shop, const Stage& first,
                                      const Trodden& best) {
  if (best.rounds.empty() || is_explained(shop, best.stage) || shop.cancelled()) return {};
  std::vector<std::string> begun;  // on which the second round has tried all others
  if (best.rounds.size() > 1) begun = best.rounds[1].before.added;
  const std::vector<Candidate> pairs = two_at_once(shop, first, begun);
  if (pairs.empty() || !is_gain(shop, first, pairs.front())) return {};
  return trodden_from(shop, first, pairs.front(), best.rounds.front());
}

/// The search one effect after another, or with two at once where that leads further.
Trodden search(const Workshop& shop, const Stage& first) {
  Trodden best{first, {}};
  const bool may_go_on = go_on(shop, best.stage, best.rounds, true, kBeforeTwoAtOnce);
  std::optional<Trodden> other = start_with_two(shop, first, best);
  if (other && is_explained(shop, other->stage) && leads_further(*other, best)) return *other;
  if (may_go_on) go_on(shop, best.stage, best.rounds, true);
  look_over(shop, best.stage, Look::on_the_way);
  return other && leads_further(*other, best) ? *other : best;
}

/// The next best effects of the first round as the beginning.
void detour(const Workshop& shop, const Stage& first, Trodden& best) {
  if (best.rounds.empty()) return;
  const std::vector<Candidate> firsts = best.rounds.front().candidates;
  for (std::size_t i = 1; i < std::min(kDetours, firsts.size()); ++i) {
    if (best.stage.fitted.score_rms_m < kLost * shop.evidence.noise_floor_m || shop.cancelled() ||
        !is_gain(shop, first, firsts[i]) ||
        firsts[i].score_rms_m > kHelpful * first.fitted.score_rms_m) {
      break;
    }
    const double apart_m =
        rms(firsts[i].fitted.residual_m - firsts.front().fitted.residual_m, shop.evidence.counts);
    if (apart_m < kSamePath * firsts[i].score_rms_m) continue;
    const auto& added = best.stage.added;
    if (std::find(added.begin(), added.end(), firsts[i].effects.front()) != added.end()) continue;
    Trodden other = trodden_from(shop, first, firsts[i], best.rounds.front());
    if (leads_further(other, best)) best = std::move(other);
  }
}

}  // namespace

double worthwhile_at(const Workshop& shop, double score_rms_m) {
  return score_rms_m < kUnexplained * shop.evidence.noise_floor_m ? kWorthwhileInNoise
                                                                  : kWorthwhile;
}

double nominal_rms_m(const Workshop& shop) {
  EvidenceRun run(shop.model, shop.evidence, shop.standing);
  Eigen::MatrixXd residuals_m;
  run.residuals(start_of(shop.model, shop.standing), residuals_m);
  return rms(residuals_m.col(0), shop.evidence.scores);
}

Stage first_stage(const Workshop& shop) {
  FitOptions options;
  options.tolerance = 1e-5;
  options.cancel = shop.cancel;
  options.threads = shop.threads;
  return {{},
          fit(shop.model, shop.evidence, shop.evidence.fits, shop.standing,
              start_of(shop.model, shop.standing), options)};
}

Ladder climb(const Workshop& shop) {
  const auto begin = std::chrono::steady_clock::now();
  Ladder ladder;
  ladder.nominal_rms_m = nominal_rms_m(shop);
  const Stage first = first_stage(shop);
  ladder.preview_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Trodden best = search(shop, first);
  if (!best.rounds.empty()) ladder.preview_s += best.rounds.front().looked_s;
  detour(shop, first, best);
  const Stage& stage = best.stage;
  ladder.rounds = std::move(best.rounds);
  ladder.way = way_to(shop, first, stage);
  if (!is_explained(shop, stage)) {
    std::vector<Stage> supported = supported_way(shop, ladder.way);
    // interrupted in the midst of it: what was found stays
    if (!shop.cancelled()) {
      Stage last = supported.back();
      look_over(shop, last, Look::final);
      const bool dropped = last.added.size() < supported.back().added.size();
      ladder.way = dropped ? way_to(shop, first, last) : std::move(supported);
      if (!dropped) ladder.way.back() = std::move(last);
    }
  }
  ladder.final = ladder.way.back();
  ladder.interrupted = shop.cancelled();
  return ladder;
}

}  // namespace estimator::greybox::selection
