#include "estimator/greybox/selection/innovation_round.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/further_refinements.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_rivals.h"
#include "estimator/greybox/selection/resonance_or_line.h"
#include "estimator/greybox/selection/rig_scale.h"
#include "estimator/greybox/selection/settled_trials.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

constexpr std::size_t kMostLines = 4;
/// Candidates of a round that get a noise model of their own.
constexpr std::size_t kRoundFinalists = 3;
constexpr std::size_t kMostLineFinalists = 2;
/// Lead of the likeliest candidate that another may make up for when its noise model and parameters
/// have converged together.
constexpr double kContends_nats = 30.0;
/// The same for an effect behind a spectral line, as a share of the line's gain: a line is exact at
/// once, and stands for a resonance whose parameters and noise model have yet to find each other.
constexpr double kContendsWithLine = 0.7;
/// Distance of a spring's rest from the motion, in RMS of that, from which on it is hardly more
/// than a constant force; and share of its gain that this then has.
constexpr double kFarRest = 4.0;
constexpr double kMostOfSpring = 0.8;

/// Drops effects that have left their range since others came in: these, or a law that the library
/// does not have, are what they stood for.
void drop_out_of_range(const SearchContext& plain, InnovationStage& stage,
                       std::set<std::string>& dropped) {
  for (std::string effect = effect_out_of_range(stage); !effect.empty() && !plain.cancelled();
       effect = effect_out_of_range(stage)) {
    stage = without(plain, stage, effect);
    dropped.insert(std::move(effect));
  }
}

std::vector<InnovationTrial> line_trials(const SearchContext& plain, const InnovationStage& stage) {
  std::vector<InnovationTrial> trials;
  std::vector<ScoredLine> lines = line_candidates(plain, stage);
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLineFinalists); ++i) {
    InnovationTrial trial;
    trial.candidate.line = lines[i].line;
    trial.penalty_nats = kPerParameter_nats * kParametersOfLine;
    trial.candidate.gain_nats = lines[i].gain_nats - trial.penalty_nats;
    trial.starts = {stage.model};
    trials.push_back(std::move(trial));
  }
  return trials;
}

/// The trials of a round and the stage that each leads to.
class RoundTrials {
 public:
  RoundTrials(const SearchContext& plain, const InnovationStage& stage, TrialMemo& memo, int number)
      : plain_(plain), stage_(stage), memo_(memo) {
    progress_.round = number;
    progress_.by_innovations = true;
  }

  /// Gives the most promising of the trials noise models of their own.
  void settle_finalists(std::vector<InnovationTrial> trials) {
    trials_ = std::move(trials);
    sort_by_gain(trials_);
    std::vector<std::size_t> finalists;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const bool promising = i < kRoundFinalists && trials_[i].candidate.gain_nats > 0.0;
      if (promising || !trials_[i].elsewhere.empty()) finalists.push_back(i);
    }
    settle(finalists);
  }

  /// Starts the most promising effects of simulations from there too.
  void settle_simulated(const SimulatedEffects& effects) {
    add_simulated_starts(stage_, effects, trials_);
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      if (trials_[i].simulated) promising.push_back(i);
    }
    settle(promising);
  }

  /// The likeliest candidate that gains `evidence_nats` within its range, all that contend with it
  /// polished; the number of trials: there is none.
  std::size_t choose(double evidence_nats) {
    std::size_t chosen = likeliest(evidence_nats);
    while (chosen != none() && polished_[chosen] == 0 && !plain_.cancelled()) {
      polish_contenders(chosen);
      chosen = likeliest(evidence_nats);
    }
    return chosen == none() ? chosen : constant_force_instead(chosen, evidence_nats);
  }

  [[nodiscard]] std::size_t none() const { return trials_.size(); }
  [[nodiscard]] InnovationStage& stage(std::size_t i) { return stages_[i]; }
  [[nodiscard]] const InnovationCandidate& candidate(std::size_t i) const {
    return trials_[i].candidate;
  }

  [[nodiscard]] InnovationRound report(std::size_t chosen) {
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      trials_[i].candidate.penalty_nats = trials_[i].penalty_nats;
      if (trials_[i].candidate.settled) trials_[i].candidate.fitted = stages_[i].model.fitted;
      trials_[i].candidate.fitted.jacobian.resize(0, 0);
    }
    InnovationRound round{stage_.model, {}, chosen != none()};
    round.before.fitted.jacobian.resize(0, 0);
    if (chosen != none()) round.candidates.push_back(trials_[chosen].candidate);
    std::vector<std::size_t> others(trials_.size());
    std::iota(others.begin(), others.end(), std::size_t{0});
    std::erase(others, chosen);
    std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
      const InnovationCandidate& one = trials_[a].candidate;
      const InnovationCandidate& other = trials_[b].candidate;
      if (one.settled != other.settled) return one.settled;
      return one.gain_nats > other.gain_nats;
    });
    for (const std::size_t i : others) round.candidates.push_back(trials_[i].candidate);
    return round;
  }

 private:
  void take(std::size_t i, InnovationStage reached) {
    stages_[i] = std::move(reached);
    trials_[i].candidate.gain_nats =
        0.5 * (stage_.minus_two_log - stages_[i].minus_two_log) - trials_[i].penalty_nats;
  }

  void settle(const std::vector<std::size_t>& chosen) {
    progress_.of += static_cast<int>(chosen.size());
    stages_.resize(trials_.size());
    polished_.resize(trials_.size(), 0);
    std::vector<InnovationTrial> unknown;
    for (const std::size_t i : chosen) {
      InnovationTrial& trial = unknown.emplace_back(trials_[i]);
      if (!trial.candidate.settled) continue;
      trial.starts = {trials_[i].starts.back()};
      trial.elsewhere.clear();
    }
    std::vector<InnovationStage> reached =
        settle_trials(plain_, stage_, unknown, [&](std::size_t k) { report_progress(chosen[k]); });
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const std::size_t i = chosen[k];
      if (!(reached[k].minus_two_log < stages_[i].minus_two_log)) continue;
      take(i, std::move(reached[k]));
      trials_[i].candidate.settled = true;
      polished_[i] = 0;
    }
  }

  void report_progress(std::size_t trial) {
    if (!plain_.options.progress) return;
    const std::string& effect = trials_[trial].candidate.effect;
    ++progress_.done;
    progress_.effect = effect.empty() ? "a spectral line" : effect;
    plain_.options.progress(progress_);
  }

  // an effect that leaves its range, at once or with its noise model settled, stands for another
  [[nodiscard]] std::size_t likeliest(double evidence_nats) const {
    const std::size_t own = stage_.model.fitted.parameters.size();
    std::size_t best = none();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const InnovationCandidate& candidate = trials_[i].candidate;
      if (!candidate.settled || !(candidate.gain_nats >= evidence_nats)) continue;
      if (leaves_its_range(stages_[i].model.fitted, own)) continue;
      if (best == none() || candidate.gain_nats > trials_[best].candidate.gain_nats) best = i;
    }
    return best;
  }

  /// The constant force in place of a spring that is hardly more: its slope may stand for what is
  /// not found yet, and gains in the next round where it is real.
  std::size_t constant_force_instead(std::size_t chosen, double evidence_nats) {
    if (trials_[chosen].candidate.effect != "load_spring") return chosen;
    const RigScale rig = rig_scale(plain_.problem.model, plain_.problem.data);
    const double rest_m = stages_[chosen].model.fitted.value("load_spring.rest_m");
    if (!(std::abs(rest_m - rig.centre_m) > kFarRest * rig.length_m)) return chosen;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      if (trials_[i].candidate.effect != "load_force") continue;
      if (!trials_[i].candidate.settled) settle({i});
      if (polished_[i] == 0) polish_contenders(i);
      const double spring_nats = trials_[chosen].candidate.gain_nats;
      const double enough_nats = std::max(evidence_nats, kMostOfSpring * spring_nats);
      if (trials_[i].candidate.settled && trials_[i].candidate.gain_nats >= enough_nats) return i;
    }
    return chosen;
  }

  /// True for lines that the record tells apart by their frequency.
  [[nodiscard]] bool is_apart(std::size_t a, std::size_t b) const {
    const double by_Hz =
        trials_[a].candidate.line.frequency_Hz - trials_[b].candidate.line.frequency_Hz;
    return std::abs(by_Hz) * length_s(plain_.problem.data) > 1.0;
  }

  void polish_contenders(std::size_t best) {
    const double best_nats = trials_[best].candidate.gain_nats;
    const bool is_line = trials_[best].candidate.effect.empty();
    std::vector<std::size_t> contenders;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const InnovationCandidate& candidate = trials_[i].candidate;
      double lead_nats = kContends_nats;
      if (is_line && !candidate.effect.empty())
        lead_nats = std::max(lead_nats, kContendsWithLine * best_nats);
      // another line can still be taken in the next round
      if (i != best && is_line && candidate.effect.empty() && is_apart(i, best)) continue;
      const bool contends = candidate.gain_nats > best_nats - lead_nats;
      if (contends && candidate.settled && polished_[i] == 0) contenders.push_back(i);
    }
    const unsigned threads = plain_.options.threads;
    const SimulationWidth width = contenders.size() == 1 ? wide(threads) : SimulationWidth{};
    in_parallel(contenders.size(), threads, [&](std::size_t k) {
      const std::size_t i = contenders[k];
      if (plain_.cancelled()) return;
      polished_[i] = 1;
      InnovationStage polished =
          settled(plain_, stages_[i].model, stages_[i].noise, Settling::fully, width);
      if (polished.minus_two_log < stages_[i].minus_two_log) take(i, std::move(polished));
    });
  }

  const SearchContext& plain_;
  const InnovationStage& stage_;
  TrialMemo& memo_;
  std::vector<InnovationTrial> trials_;
  std::vector<InnovationStage> stages_;
  std::vector<char> polished_;
  SearchProgress progress_;
};

}  // namespace

std::vector<InnovationStage> at_other_sites(const SearchContext& plain,
                                            const InnovationStage& stage, std::size_t line) {
  std::vector<disturbance::LineSite> sites = disturbance::sites_of(stage.linear.front());
  std::erase(sites, stage.noise.lines[line].site);
  std::vector<InnovationStage> others(sites.size());
  in_parallel(sites.size(), plain.options.threads, [&](std::size_t k) {
    others[k] = settled(plain, stage.model, moved(stage.noise, line, sites[k]), Settling::once,
                        SimulationWidth{});
  });
  return others;
}

void reconsider_sites(const SearchContext& plain, InnovationStage& stage) {
  for (std::size_t i = 0; i < stage.noise.lines.size(); ++i) {
    std::vector<InnovationStage> others = at_other_sites(plain, stage, i);
    const auto best = std::min_element(
        others.begin(), others.end(),
        [](const auto& a, const auto& b) { return a.minus_two_log < b.minus_two_log; });
    if (best != others.end() && best->minus_two_log < stage.minus_two_log - 2.0) {
      stage = std::move(*best);
    }
  }
}

std::string effect_out_of_range(const InnovationStage& stage) {
  const FitSummary& fitted = stage.model.fitted;
  for (const std::string& effect : stage.model.added) {
    for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
      if (!belongs_to(fitted.parameters[i], effect)) continue;
      if (leaves_its_range(fitted, i, i + 1) ||
          rings_with_a_line(stage, fitted.parameters[i],
                            fitted.theta[static_cast<Eigen::Index>(i)])) {
        return effect;
      }
    }
  }
  return "";
}

bool extend(const SearchContext& plain, InnovationStage& stage, const RoundOptions& options,
            TrialMemo& memo, std::vector<InnovationRound>& rounds, std::set<std::string>& dropped) {
  const bool effects_too = options.candidates == Candidates::effects_and_lines;
  const bool may_grow = effects_too && stage.model.added.size() < options.most_effects;
  std::vector<InnovationTrial> first;
  if (may_grow) first = memo.effects_beside(stage);
  std::erase_if(first, [&](const InnovationTrial& trial) {
    return dropped.contains(trial.candidate.effect);
  });
  if (stage.noise.lines.size() < kMostLines) {
    std::vector<InnovationTrial> lines = line_trials(plain, stage);
    std::move(lines.begin(), lines.end(), std::back_inserter(first));
  }
  RoundTrials trials(plain, stage, memo, static_cast<int>(rounds.size()) + 1);
  trials.settle_finalists(std::move(first));
  std::size_t chosen = trials.choose(options.evidence_nats);
  // simulations cost as much as the rest of a round: they run where that leaves something
  const InnovationStage& reached = chosen == trials.none() ? stage : trials.stage(chosen);
  if (may_grow && (memo.simulated.knows(stage.model) || leaves_physics(reached))) {
    SimulatedEffects beside = memo.simulated.beside(plain, stage.model);
    std::erase_if(beside.effects,
                  [&](const SimulatedEffect& one) { return dropped.contains(one.effect); });
    trials.settle_simulated(beside);
    chosen = trials.choose(options.evidence_nats);
  }
  rounds.push_back(trials.report(chosen));
  if (chosen == trials.none()) return false;
  const bool is_effect = !trials.candidate(chosen).effect.empty();
  stage = InnovationStage(std::move(trials.stage(chosen)));
  if (!effects_too) return true;
  if (is_effect) {
    if (auto other = without_lines_of_resonance(plain, stage)) stage = *std::move(other);
  }
  drop_out_of_range(plain, stage, dropped);
  if (is_effect) {
    take_further_refinements(plain, options.evidence_nats, stage);
    reconsider_sites(plain, stage);
  }
  return true;
}

}  // namespace estimator::greybox::selection
