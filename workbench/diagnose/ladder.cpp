#include "workbench/diagnose/ladder.h"

#include <algorithm>

#include "workbench/diagnose/look_over.h"
#include "workbench/diagnose/parallel.h"
#include "workbench/diagnose/rounds.h"

namespace workbench::diagnose {
namespace {

constexpr std::size_t kMostEffects = 4;
/// Of the first round, that many are tried as the first effect when the best leads nowhere.
constexpr std::size_t kDetours = 3;
/// A gain must also be more than chance.
constexpr double kChance = 0.01;

bool is_gain(const Stage& stage, const Candidate& candidate) {
  return candidate.fitted_at_all && candidate.p_value < kChance &&
         candidate.score_rms_m <
             (1.0 - kWorthwhile * static_cast<double>(candidate.effects.size())) *
                 stage.fitted.score_rms_m;
}

bool explained(const Workshop& shop, const Stage& stage) {
  return stage.fitted.score_rms_m <= kUnexplained * shop.evidence.noise_floor_m;
}

/// Of candidates that explain the record alike, the one with the fewest parameters.
const Candidate& simplest(const Workshop& shop, const std::vector<Candidate>& candidates) {
  const Candidate* chosen = &candidates.front();
  for (const Candidate& other : candidates) {
    if (!other.fitted_at_all || other.effects.size() > chosen->effects.size()) continue;
    if (other.fitted.searched.size() < chosen->fitted.searched.size() &&
        other.score_rms_m < (1.0 + kWorthwhile) * candidates.front().score_rms_m &&
        chance(shop, other.fitted, candidates.front().fitted) > kChance) {
      chosen = &other;
    }
  }
  return *chosen;
}

/// Rounds from a stage until nothing helps any more.
void go_on(const Workshop& shop, Stage& stage, std::vector<Round>& rounds) {
  while (stage.added.size() < kMostEffects && !shop.cancelled()) {
    Round round = single_round(shop, stage, static_cast<int>(rounds.size()) + 1);
    if (round.candidates.empty()) return;
    const bool single = is_gain(stage, round.candidates.front());
    if (!single && !explained(shop, stage) && !shop.cancelled()) {
      std::vector<Candidate> pairs = pair_round(shop, round);
      if (!pairs.empty() && is_gain(stage, pairs.front())) {
        round.candidates.insert(round.candidates.begin(), pairs.front());
      }
    }
    const bool gain = is_gain(stage, round.candidates.front());
    if (gain) stage = with(stage, simplest(shop, round.candidates));
    rounds.push_back(std::move(round));
    if (!gain) return;
  }
}

}  // namespace

Stage first_stage(const Workshop& shop) {
  matching::FitOptions options;
  options.tolerance = 1e-5;
  options.cancel = shop.cancel;
  return {{},
          matching::fit(shop.model, shop.evidence, shop.evidence.fits, shop.standing,
                        matching::start_of(shop.model, shop.standing), options)};
}

std::vector<Glance> preview(const Workshop& shop, const Stage& stage) {
  const std::vector<Eigen::VectorXd> bases = bases_of(shop, stage);
  std::vector<Glance> glances(shop.absent.size());
  in_parallel(glances.size(), shop.threads,
              [&](std::size_t i) { glances[i] = glance(shop, stage, bases, shop.absent[i]); });
  std::stable_sort(glances.begin(), glances.end(), [](const Glance& a, const Glance& b) {
    return a.expected_ratio < b.expected_ratio;
  });
  return glances;
}

Ladder climb(const Workshop& shop) {
  Ladder ladder;
  {
    matching::EvidenceRun run(shop.model, shop.evidence, shop.standing);
    Eigen::MatrixXd residuals_m;
    run.residuals(matching::start_of(shop.model, shop.standing), residuals_m);
    ladder.nominal_rms_m = matching::rms(residuals_m.col(0), shop.evidence.scores);
  }
  Stage stage = first_stage(shop);
  const Stage first = stage;
  go_on(shop, stage, ladder.rounds);
  look_over(shop, stage);
  const std::vector<Candidate> firsts =
      ladder.rounds.empty() ? std::vector<Candidate>{} : ladder.rounds.front().candidates;
  for (std::size_t i = 1; i < std::min(kDetours, firsts.size()); ++i) {
    if (explained(shop, stage) || shop.cancelled() || !is_gain(first, firsts[i])) break;
    if (std::find(stage.added.begin(), stage.added.end(), firsts[i].effects.front()) !=
        stage.added.end()) {
      continue;
    }
    std::vector<Round> rounds{ladder.rounds.front()};
    Stage other = with(first, firsts[i]);
    go_on(shop, other, rounds);
    look_over(shop, other);
    if (other.fitted.score_rms_m < (1.0 - kRivals) * stage.fitted.score_rms_m) {
      stage = std::move(other);
      ladder.rounds = std::move(rounds);
    }
  }
  ladder.final = std::move(stage);
  ladder.interrupted = shop.cancelled();
  return ladder;
}

}  // namespace workbench::diagnose
