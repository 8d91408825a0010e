#include "estimator/greybox/selection/learned_curve.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "estimator/greybox/selection/beside_curve.h"
#include "estimator/greybox/selection/curve_place.h"
#include "estimator/greybox/selection/rig_scale.h"
#include "estimator/greybox/selection/settled_memo.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"
#include "estimator/parallel.h"
#include "plant_sim/formula/curve_effect.h"

namespace estimator::greybox::selection {
namespace {

using plant_sim::formula::FormulaEffect;

/// Sites and variables that are fitted, the likeliest first.
constexpr std::size_t kTried = 2;
constexpr std::size_t kFirstPoints = 8;
/// Numbers of points of the likeliest of these, then twice as many as long as the most do best.
constexpr std::initializer_list<std::size_t> kFurtherPoints = {5, 14};
constexpr std::size_t kMostPoints = 28;
/// Share of what the first curve leaves that one through more points has to undercut, where it
/// leaves much: otherwise something else is missing too.
constexpr double kHardlyLess = 0.75;
/// Share of what a curve has explained that others may gain beside it: between a few points it is a
/// cubic, whatever the law.
constexpr double kInexactCurves = 0.02;
/// Standard deviation of a curve's values about zero, in typical sizes.
constexpr double kPriorSizes = 5.0;
/// Share of what a curve leaves to others that one candidate beside it has to promise.
constexpr double kMostOfRest = 0.5;
/// Lag of a curve behind another model, and its share of what that explains, that more points and
/// convergence do not make up for.
constexpr double kFarBehind_nats = 200.0;
constexpr double kShareOfBest = 0.5;
/// Largest value of a curve over its typical one.
constexpr double kMostOfCurve = 100.0;

FormulaEffect effect_of(const CurvePlace& place, std::vector<double> points) {
  FormulaEffect effect;
  effect.name = name_of(place);
  effect.site = place.site;
  effect.what = "a curve, since no formula of the dictionary fits";
  const std::vector<double> sizes(points.size(), place.typical);
  effect.curve = {place.over, place.times, std::move(points), sizes};
  derive_formula(effect);
  for (FormulaEffect::Parameter& p : effect.parameters) {
    p.min = -kMostOfCurve * place.typical;
    p.max = kMostOfCurve * place.typical;
  }
  return effect;
}

struct Attempt {
  CurvePlace place;
  FormulaEffect effect;
  SearchContext context;
  InnovationStage stage;
  bool is_not_alone = false;  ///< more points leave hardly less: something else is missing too
};

/// True where a parameter of the plant that is free sets the level of the curve.
bool plant_has_level(const CurvePlace& place, const FitSummary& fitted) {
  return place.times == "v_mps" && std::isfinite(fitted.value("damping_N_s_per_m"));
}

/// The stage with the curve, which begins at zero.
InnovationStage fitted(const Attempt& attempt, const InnovationStage& stage) {
  ModelStage model = stage.model;
  ParameterSubset all = subset(model.fitted, [](const auto&) { return true; });
  const std::vector<plant_sim::EffectInfo> effects =
      plant_sim::effects_of(attempt.context.problem.model);
  std::vector<FreeParameter> own = effect_parameters(effects.back(), kEveryRefinement);
  const CurvePlace& place = attempt.place;
  for (std::size_t i = 0; i < own.size() && place.dissipates; ++i) {
    const double speed_mps = attempt.effect.curve->x[i];
    if (speed_mps > 0.0) own[i].lower = 0.0;
    if (speed_mps < 0.0) own[i].upper = 0.0;
  }
  // the whole level is the friction's, or the plant's: the curve is none in the middle
  if (place.site == kFrictionLevel || plant_has_level(place, model.fitted))
    own.erase(own.begin() + static_cast<std::ptrdiff_t>(own.size() / 2));
  // what a curve shares with the model's own parameters, a slope with a gain, is the model's
  for (FreeParameter& p : own) p.prior_sd = kPriorSizes;
  append(all, {own, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(own.size()))});
  SearchContext with_gains = attempt.context;
  with_gains.problem.data = stage.context.problem.data;
  model.fitted = fit_innovations(with_gains, all, SimulationWidth{}, InnovationFit::trial);
  model.added.push_back(attempt.effect.name);
  return settled(attempt.context, std::move(model), stage.noise, Settling::once, SimulationWidth{});
}

/// The curve at a place through so many points; none where the signal hardly varies.
std::optional<Attempt> attempt_at(const SearchContext& context, const CurvePlace& place,
                                  std::size_t count) {
  std::vector<double> points = curve_points(context, place, count);
  if (points.empty()) return {};
  Attempt attempt{place, effect_of(place, std::move(points)), context, {}};
  attempt.context.problem.model.declare(attempt.effect, "learned curve");
  return attempt;
}

std::vector<Attempt> first_attempts(const SearchContext& context, const InnovationStage& stage) {
  const RigScale rig = rig_scale(context.problem.model, context.problem.data);
  std::vector<Attempt> attempts;
  std::vector<std::string> names;
  for (const CurveGain& curve : curve_gains(stage)) {
    if (names.size() == kTried || !(curve.gain_nats > kCurve_nats)) break;
    const std::optional<CurvePlace> place = curve_place(context, rig, curve);
    if (!place || std::find(names.begin(), names.end(), name_of(*place)) != names.end()) continue;
    names.push_back(name_of(*place));
    if (std::optional<Attempt> attempt = attempt_at(context, *place, kFirstPoints))
      attempts.push_back(std::move(*attempt));
  }
  // the score test knows no friction whose level changes: gains and drags stand in for it
  if (rubs(context, stage.model.added)) {
    const CurvePlace place = friction_level();
    if (std::optional<Attempt> attempt = attempt_at(context, place, kFirstPoints))
      attempts.push_back(std::move(*attempt));
  }
  return attempts;
}

/// Fits the attempts from `first` on, and sorts all, the likeliest first.
void fit_attempts(const SearchContext& context, const InnovationStage& stage, std::size_t first,
                  std::vector<Attempt>& attempts) {
  in_parallel(attempts.size() - first, context.options.threads, [&](std::size_t i) {
    if (!context.cancelled()) attempts[first + i].stage = fitted(attempts[first + i], stage);
  });
  std::stable_sort(attempts.begin(), attempts.end(), [](const Attempt& a, const Attempt& b) {
    return penalised(a.stage) < penalised(b.stage);
  });
}

std::size_t points(const Attempt& attempt) { return attempt.effect.curve->x.size(); }

/// True where another model explains far more of the record: a curve that is the law is not
/// hundreds of nats behind one that is not.
bool is_far_behind(const SearchContext& context, const InnovationStage& curve,
                   const InnovationStage& without) {
  if (!context.memo) return false;
  const double least = context.memo->least_minus_two_log(context);
  return penalised(curve) > least + 2.0 * kFarBehind_nats &&
         penalised(without) - penalised(curve) < kShareOfBest * (penalised(without) - least);
}

/// The likeliest curve; none where no curve promises anything.
std::optional<Attempt> likeliest(const SearchContext& context, const InnovationStage& stage) {
  std::vector<Attempt> attempts = first_attempts(context, stage);
  fit_attempts(context, stage, 0, attempts);
  if (attempts.empty() || context.cancelled()) return {};
  // a curve that leaves more than it gains is no law of its variable
  const InnovationStage& first = attempts.front().stage;
  if (is_far_behind(context, first, stage)) return {};
  const double first_left_nats = largest_curve_nats(first);
  if (first_left_nats > 0.5 * (penalised(stage) - penalised(first))) return {};
  const CurvePlace place = attempts.front().place;
  const auto try_counts = [&](std::initializer_list<std::size_t> counts) {
    const std::size_t tried = attempts.size();
    for (const std::size_t count : counts) {
      if (std::optional<Attempt> attempt = attempt_at(context, place, count))
        attempts.push_back(std::move(*attempt));
    }
    fit_attempts(context, stage, tried, attempts);
  };
  try_counts(kFurtherPoints);
  const InnovationStage& best = attempts.front().stage;
  const bool is_not_alone =
      leaves_much_physics(best, 0.0) && largest_curve_nats(best) > kHardlyLess * first_left_nats;
  std::size_t most = std::max(kFurtherPoints);
  while (!is_not_alone && most < kMostPoints && !context.cancelled() &&
         points(attempts.front()) == most) {
    most *= 2;
    try_counts({most});
  }
  if (context.cancelled()) return {};
  attempts.front().is_not_alone = is_not_alone;
  return std::move(attempts.front());
}

/// True where the curve leaves so much to others that converging, which gains some tens of nats,
/// and lines do not make up for it.
bool leaves_too_much(const Attempt& curve, const InnovationStage& without) {
  const double gain_nats = 0.5 * (penalised(without) - penalised(curve.stage));
  const double inexact_nats =
      kInexactCurves * (std::max(0.0, gain_nats) + curve.context.problem.interpolated_nats);
  if (!leaves_much_physics(curve.stage, inexact_nats)) return false;
  const std::vector<ScoredLine> lines = line_candidates(curve.context, curve.stage);
  return lines.empty() || lines.front().gain_nats < largest_curve_nats(curve.stage);
}

struct Learned {
  LawSearch search;
  bool alone = true;  ///< it leaves little to others
};

/// The likeliest curve beside the base, which may leave something to effects or laws beside it.
std::optional<Learned> curve_beside(const SearchContext& with_holdouts, const ModelStage& base) {
  const SearchContext context = without_holdouts(with_holdouts);
  const SimulationWidth width = wide(context.options.threads);
  const InnovationStage stage = settled(context, base, {}, Settling::fully, width);
  if (!std::isfinite(stage.minus_two_log) || context.cancelled()) return {};
  std::optional<Attempt> best = likeliest(context, stage);
  if (!best) return {};
  Learned learned{{best->context, base, {}, {{best->effect, {best->place.variable}}}},
                  !best->is_not_alone && !leaves_too_much(*best, stage)};
  learned.search.context.problem.data = with_holdouts.problem.data;
  learned.search.context.problem.candidate_effects.clear();
  InnovationSearch& search = learned.search.innovations;
  search.final = std::move(best->stage);
  if (!learned.alone && !(promised_beside_nats(with_holdouts, learned.search) >
                          kMostOfRest * largest_curve_nats(search.final))) {
    return {};
  }
  InnovationStage found =
      settled(best->context, search.final.model, search.final.noise, Settling::fully, width);
  if (found.minus_two_log < search.final.minus_two_log) search.final = std::move(found);
  if (!(penalised(search.final) < penalised(stage) - 2.0 * kEvidence_nats)) return {};
  search.before = stage;
  InnovationCandidate candidate;
  candidate.effect = best->effect.name;
  candidate.settled = true;
  candidate.penalty_nats = penalty_nats(search.final.model.fitted, stage.model.fitted);
  candidate.gain_nats = 0.5 * (penalised(stage) - penalised(search.final));
  candidate.fitted = search.final.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  search.gains_nats[candidate.effect] = candidate.gain_nats;
  search.inexact_nats = kInexactCurves * candidate.gain_nats;
  InnovationRound round{stage.model, {std::move(candidate)}, true};
  round.before.fitted.jacobian.resize(0, 0);
  search.rounds.push_back(std::move(round));
  return learned;
}

/// The curve with spectral lines; none where it leaves physics.
std::optional<LawSearch> with_lines(Learned learned) {
  if (!learned.alone) return {};
  LawSearch& result = learned.search;
  InnovationSearch& search = result.innovations;
  const double inexact_nats = search.inexact_nats;
  const SearchContext context = without_holdouts(result.context);
  add_lines(context, search, search.final);
  search.inexact_nats += inexact_nats;
  weigh_remainder(context, search);
  if (search.physics_missing()) return {};
  return std::move(result);
}

/// The effects and laws found beside a curve, and the curve fitted anew beside them through as many
/// points as it needs there; none where one of them is no longer needed, or this is no likelier.
std::optional<LawSearch> with_beside(const LawSearch& learned, const BesideCurve& beside) {
  std::optional<Learned> again = curve_beside(beside.context, beside.without_curve.model);
  if (!again) return {};
  InnovationSearch& search = again->search.innovations;
  search.before = learned.innovations.before;
  const auto put_before = [&](const std::vector<InnovationRound>& rounds) {
    search.rounds.insert(search.rounds.begin(), rounds.begin(), rounds.end());
  };
  put_before(beside.innovations.rounds);
  put_before(learned.innovations.rounds);
  // a finer curve may do without an effect that mended a coarse one
  const SearchContext context = without_holdouts(again->search.context);
  for (const std::string& effect : search.final.model.added) {
    search.without.push_back(without(context, search.final, effect));
    const double gain_nats = 0.5 * (penalised(search.without.back()) - penalised(search.final));
    if (context.cancelled() || !(gain_nats > kEvidence_nats)) return {};
    search.gains_nats[effect] = gain_nats;
  }
  if (!(penalised(search.final) < penalised(learned.innovations.final) - 2.0 * kRivals_nats))
    return {};
  again->search.context.problem.candidate_effects = beside.context.problem.candidate_effects;
  again->search.laws.insert(again->search.laws.end(), beside.laws.begin(), beside.laws.end());
  return with_lines(std::move(*again));
}

}  // namespace

std::optional<LawSearch> search_curve(const SearchContext& context, const ModelStage& base) {
  std::optional<Learned> learned = curve_beside(context, base);
  if (!learned) return {};
  const double evidence_nats = kEvidence_nats + learned->search.innovations.inexact_nats;
  if (promised_beside_nats(context, learned->search) > evidence_nats) {
    const std::optional<BesideCurve> beside = seek_beside_curve(context, learned->search);
    if (beside) {
      if (std::optional<LawSearch> result = with_beside(learned->search, *beside)) return result;
    }
  }
  return with_lines(std::move(*learned));
}

}  // namespace estimator::greybox::selection
