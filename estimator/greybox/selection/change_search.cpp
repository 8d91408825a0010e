#include "estimator/greybox/selection/change_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/selection/change_scores.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostChanges = 2;
/// Changes that are fitted, and the share of the best score from which on they are.
constexpr std::size_t kFinalists = 6;
constexpr double kWorthFitting = 0.5;
/// Range of a changed plant parameter about the present value, in logarithms.
constexpr double kRange = 2.3;
/// Gain of a curve over the motion, in those of the best change, from which on no change is sought.
constexpr double kMotionExplains = 2.0;
/// Range and step, in samples, in which the time of a change is looked for about its fit.
constexpr double kScanned_s = 1.0;
constexpr double kScanStep = 4.0;
constexpr int kScans = 3;
constexpr const char* kLoad = "load_force.force_N";
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string name_of(const ChangeScore& score) { return "change." + score.parameter.name; }

/// A length of time in a fit, within its bounds.
FreeParameter time_parameter(const std::string& name, double unit_s, double least_s,
                             double most_s) {
  return {name, ParameterScale::linear, unit_s, least_s / unit_s, most_s / unit_s, 0.0, kInfinite};
}

FreeParameter duration_parameter(const std::string& name, double start_s, double least_s,
                                 double most_s) {
  return {name,
          ParameterScale::logarithmic,
          start_s,
          std::log(least_s / start_s),
          std::log(most_s / start_s),
          0.0,
          kInfinite};
}

/// A change with its numbers, ready to be fitted.
struct Proposal {
  SearchContext context;
  ModelStage start;
  ChangeScore score;
};

class Proposals {
 public:
  Proposals(const SearchContext& plain, const InnovationStage& stage)
      : plain_(plain), stage_(stage), record_(plain.problem.data.records.front()) {}

  [[nodiscard]] Proposal proposal(const ChangeScore& score) const {
    Proposal made{plain_, stage_.model, score};
    plant_sim::Change change{.parameter = score.parameter.name, .at_s = score.at_s};
    const FitSummary& fitted = stage_.model.fitted;
    ParameterSubset all = subset(fitted, [](const auto&) { return true; });
    double theta = 0.0;
    if (score.absent) {
      append(all, {{score.parameter}, Eigen::VectorXd::Zero(1)});
    } else {
      for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
        if (fitted.parameters[i].name != score.parameter.name) continue;
        theta = fitted.theta[static_cast<Eigen::Index>(i)];
      }
    }
    FreeParameter value = score.parameter;
    value.name = name_of(score) + ".value";
    value.prior_sd = kInfinite;
    if (value.scale == ParameterScale::logarithmic) {
      value.lower = theta - kRange;
      value.upper = theta + kRange;
    }
    add(all, value, theta + score.by);
    const double begin_s = record_.t_s.front();
    const double end_s = record_.t_s.back();
    const double unit_s = 1000.0 * record_.sample_time_s;  // differences of one sample
    const bool whole = score.duration_s >= end_s - begin_s;
    if (score.kind == ChangeKind::exponential) {
      change.time_constant_s = score.duration_s;
      add(all,
          duration_parameter(name_of(score) + ".time_constant_s", score.duration_s,
                             10.0 * record_.sample_time_s, 10.0 * (end_s - begin_s)),
          0.0);
    } else if (!whole) {
      add(all, time_parameter(name_of(score) + ".at_s", unit_s, begin_s, end_s),
          score.at_s / unit_s);
    }
    if (score.kind == ChangeKind::ramp) {
      change.ramp_s = score.duration_s;
      if (!whole) {
        add(all,
            duration_parameter(name_of(score) + ".ramp_s", score.duration_s,
                               4.0 * record_.sample_time_s, end_s - begin_s),
            0.0);
      }
    }
    change.value = value.to_physical(theta);
    made.context.problem.model.changes.push_back(change);
    made.start.added.push_back(name_of(score));
    made.start.fitted.parameters = all.parameters;
    made.start.fitted.theta = all.start;
    return made;
  }

 private:
  static void add(ParameterSubset& all, const FreeParameter& parameter, double theta) {
    Eigen::VectorXd start(1);
    start[0] = std::clamp(theta, parameter.lower, parameter.upper);
    append(all, {{parameter}, start});
  }

  const SearchContext& plain_;
  const InnovationStage& stage_;
  const Dataset& record_;
};

/// The scores worth a fit, and for the likeliest steps ramps about them.
std::vector<ChangeScore> finalists(const InnovationStage& stage, double evidence_nats) {
  std::vector<ChangeScore> scores = change_scores(stage);
  if (scores.empty()) return {};
  const double least = std::max(evidence_nats, kWorthFitting * scores.front().gain_nats);
  std::erase_if(scores, [&](const ChangeScore& score) { return score.gain_nats < least; });
  scores.resize(std::min(scores.size(), kFinalists));
  return scores;
}

/// Sets the time of a change to the likeliest within kScanned_s, the other parameters held: the
/// likelihood has a minimum about every pause of the motion. False where it is that already.
bool scan_time(const SearchContext& context, const std::string& name, FitSummary& fitted) {
  const auto at = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                               [&](const FreeParameter& p) { return p.name == name; });
  if (at == fitted.parameters.end()) return false;
  const auto row = static_cast<Eigen::Index>(at - fitted.parameters.begin());
  const double step = kScanStep * context.problem.data.sample_time_s / at->unit;
  const auto half = static_cast<int>(kScanned_s / at->unit / step);
  DatasetSimulation run(context.problem.model, context.problem.data, fitted.parameters);
  double least = rms(fitted.residual_m, context.problem.data.training_mask);
  double best = fitted.theta[row];
  constexpr int kLanes = static_cast<int>(ObserverSimulation::kLanes);
  Eigen::MatrixXd residuals_m;
  for (int from = -half; from <= half && !context.cancelled(); from += kLanes) {
    Eigen::MatrixXd points = fitted.theta.replicate(1, kLanes);
    for (int i = 0; i < kLanes; ++i) {
      points(row, i) = std::clamp(points(row, i) + step * (from + i), at->lower, at->upper);
    }
    run.residuals(points, residuals_m);
    for (int i = 0; i < kLanes; ++i) {
      const double now = rms(residuals_m.col(i), context.problem.data.training_mask);
      if (now >= least) continue;
      least = now;
      best = points(row, i);
    }
  }
  const bool moved = best != fitted.theta[row];
  fitted.theta[row] = best;
  return moved;
}

/// A proposal fitted with the stage's gains, then with a noise model of its own.
InnovationStage fitted(const Proposal& proposal, const InnovationStage& stage,
                       SimulationWidth width) {
  SearchContext with_gains = stage.context;
  with_gains.problem.model = proposal.context.problem.model;
  ModelStage start = proposal.start;
  start.fitted = fit_innovations(with_gains, {start.fitted.parameters, start.fitted.theta}, width,
                                 InnovationFit::trial);
  if (scan_time(with_gains, name_of(proposal.score) + ".at_s", start.fitted)) {
    start.fitted = fit_innovations(with_gains, {start.fitted.parameters, start.fitted.theta}, width,
                                   InnovationFit::trial);
  }
  return settled(proposal.context, std::move(start), stage.noise, 1, width);
}

/// A ramp about a step: whether it took time is decided by the likelihood.
ChangeScore ramp_about(const ChangeScore& step, const FitSummary& fitted, const Dataset& record) {
  ChangeScore ramp = step;
  const double length_s = record.t_s.back() - record.t_s.front();
  ramp.kind = ChangeKind::ramp;
  ramp.duration_s = 0.2 * length_s;
  const double at_s = fitted.value(name_of(step) + ".at_s");
  ramp.at_s = std::max(record.t_s.front(),
                       (std::isfinite(at_s) ? at_s : step.at_s) - 0.5 * ramp.duration_s);
  return ramp;
}

ChangeScore step_within(const ChangeScore& ramp, const FitSummary& fitted) {
  ChangeScore step = ramp;
  step.kind = ChangeKind::step;
  step.duration_s = 0.0;
  step.at_s = fitted.value(name_of(ramp) + ".at_s") + 0.5 * fitted.value(name_of(ramp) + ".ramp_s");
  return step;
}

double error_of(const FitSummary& fitted, const Eigen::VectorXd& errors, const std::string& name) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (fitted.parameters[i].name == name)
      return errors[k] * fitted.parameters[i].slope(fitted.theta[k]);
  }
  return std::nan("");
}

/// A change in a stage that has it, its rivals apart.
ParameterChange described(const ChangeScore& score, const FitSummary& fitted,
                          const Eigen::VectorXd& errors) {
  const std::string own = name_of(score);
  ParameterChange change;
  change.parameter = score.parameter.name;
  change.kind = score.kind;
  const auto value_or = [&](const std::string& name, double otherwise) {
    const double value = fitted.value(name);
    return std::isfinite(value) ? value : otherwise;
  };
  change.at_s = value_or(own + ".at_s", score.at_s);
  change.at_error_s = error_of(fitted, errors, own + ".at_s");
  change.duration_s = change.kind == ChangeKind::step ? 0.0
                      : change.kind == ChangeKind::ramp
                          ? value_or(own + ".ramp_s", score.duration_s)
                          : value_or(own + ".time_constant_s", score.duration_s);
  change.from = value_or(change.parameter, 0.0);
  change.from_error = error_of(fitted, errors, change.parameter);
  change.to = fitted.value(own + ".value");
  change.to_error = error_of(fitted, errors, own + ".value");
  return change;
}

/// The likeliest; the plant's own parameter where an absent effect's is hardly likelier: they are
/// one where the equations are.
std::size_t best_of(const std::vector<Proposal>& proposals,
                    const std::vector<InnovationStage>& stages) {
  const auto cost = [&](std::size_t i) {
    return penalised(stages[i]) + (proposals[i].score.absent ? 2.0 * kEvidence_nats : 0.0);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < stages.size(); ++i) {
    if (cost(i) < cost(best)) best = i;
  }
  return best;
}

/// Drifts of what a constant disturbance looks like: the innovations forget them as well.
void add_drifts(const InnovationStage& stage, std::vector<ChangeScore>& scores) {
  const Dataset& record = stage.context.problem.data.records.front();
  for (const plant_sim::EffectInfo& effect : stage.context.problem.candidate_effects) {
    if (effect.name != "null_bias" && effect.name != "load_force") continue;
    ChangeScore score;
    score.parameter = effect_parameters(effect, 0).front();
    score.absent = true;
    score.kind = ChangeKind::ramp;
    score.at_s = record.t_s.front();
    score.duration_s = record.t_s.back() - record.t_s.front();
    scores.push_back(score);
  }
}

/// A load that sets in: the innovations forget it at once, so that no score shows it.
ChangeScore load_score(const InnovationStage& stage, const disturbance::ForceJump& jump) {
  ChangeScore score;
  score.at_s = jump.time_s;
  score.gain_nats = jump.gain_nats;
  for (const FreeParameter& own : stage.model.fitted.parameters) {
    if (own.name == kLoad) score.parameter = own;
  }
  for (const plant_sim::EffectInfo& effect : stage.context.problem.candidate_effects) {
    if (effect.name + ".force_N" != kLoad) continue;
    score.parameter = effect_parameters(effect, 0).front();
    score.absent = true;
  }
  if (!score.parameter.name.empty()) score.by = jump.size / score.parameter.unit;
  return score;
}

/// Adds the likeliest change; false when none gains enough.
bool add_change(const SearchContext& plain, InnovationStage& stage, ChangeSearch& search,
                std::vector<ChangeScore>& scores_taken) {
  const Dataset& record = plain.problem.data.records.front();
  const Proposals propose(search.context, stage);
  std::vector<Proposal> proposals;
  std::vector<ChangeScore> scores = finalists(stage, kEvidence_nats);
  const ChangeScore load = load_score(stage, likeliest_jump(stage));
  if (load.gain_nats > kEvidence_nats && !load.parameter.name.empty()) scores.push_back(load);
  add_drifts(stage, scores);
  for (const ChangeScore& score : scores) {
    const bool taken = std::any_of(
        search.changes.begin(), search.changes.end(),
        [&](const ParameterChange& one) { return one.parameter == score.parameter.name; });
    if (!taken) proposals.push_back(propose.proposal(score));
  }
  std::vector<InnovationStage> stages(proposals.size());
  in_parallel(proposals.size(), plain.options.threads,
              [&](std::size_t i) { stages[i] = fitted(proposals[i], stage, SimulationWidth{}); });
  if (stages.empty() || plain.cancelled()) return false;
  const auto also = [&](const ChangeScore& score) {
    proposals.push_back(propose.proposal(score));
    stages.push_back(fitted(proposals.back(), stage, wide(plain.options.threads)));
    return proposals.size() - 1;
  };
  const std::size_t first = best_of(proposals, stages);
  if (proposals[first].score.kind == ChangeKind::step) {
    const std::size_t ramp =
        also(ramp_about(proposals[first].score, stages[first].model.fitted, record));
    // a ramp finds the time of a step from farther away
    also(step_within(proposals[ramp].score, stages[ramp].model.fitted));
  }
  const std::size_t chosen = best_of(proposals, stages);
  const Proposal& taken = proposals[chosen];
  if (!(penalised(stages[chosen]) < penalised(stage) - 2.0 * kEvidence_nats)) return false;
  ParameterChange change;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string& other = proposals[i].score.parameter.name;
    if (other == taken.score.parameter.name ||
        penalised(stages[i]) > penalised(stages[chosen]) + 2.0 * kEvidence_nats ||
        std::find(change.rivals.begin(), change.rivals.end(), other) != change.rivals.end()) {
      continue;
    }
    change.rivals.push_back(other);
  }
  InnovationCandidate candidate;
  candidate.effect = name_of(taken.score);
  candidate.settled = true;
  candidate.penalty_nats = penalty_nats(stages[chosen].model.fitted, stage.model.fitted);
  candidate.gain_nats = 0.5 * (penalised(stage) - penalised(stages[chosen]));
  const InnovationStage before = std::move(stage);
  stage = settled(taken.context, stages[chosen].model, stages[chosen].noise, kMostTurns,
                  wide(plain.options.threads));
  if (!(stage.minus_two_log < stages[chosen].minus_two_log)) stage = std::move(stages[chosen]);
  // with a noise model of its own the likelihood shows the time more clearly
  for (int turn = 0; turn < kScans; ++turn) {
    ModelStage moved = stage.model;
    if (!scan_time(stage.context, name_of(taken.score) + ".at_s", moved.fitted)) break;
    InnovationStage other = settled(taken.context, std::move(moved), stage.noise, kMostTurns,
                                    wide(plain.options.threads));
    if (!(other.minus_two_log < stage.minus_two_log)) break;
    stage = std::move(other);
  }
  candidate.fitted = stage.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  InnovationRound round{before.model, {std::move(candidate)}};
  round.before.fitted.jacobian.resize(0, 0);
  search.innovations.gains_nats[round.candidates.front().effect] =
      round.candidates.front().gain_nats;
  search.innovations.rounds.push_back(std::move(round));
  change.parameter = taken.score.parameter.name;
  search.changes.push_back(std::move(change));
  scores_taken.push_back(taken.score);
  search.context = taken.context;
  return true;
}

/// True where a curve over the motion promises more than any change in time: then what is missing
/// is a law, and a change would follow it at best.
bool motion_explains_more(const InnovationStage& stage) {
  double best_change = std::max(kEvidence_nats, likeliest_jump(stage).gain_nats);
  for (const ChangeScore& score : change_scores(stage)) {
    best_change = std::max(best_change, score.gain_nats);
  }
  for (const CurveGain& curve : curve_gains(stage)) {
    if (curve.variable != "time" && curve.gain_nats > kMotionExplains * best_change) return true;
  }
  return false;
}

}  // namespace

std::optional<ChangeSearch> search_changes(const SearchContext& context, const ModelStage& base) {
  if (context.problem.data.records.size() != 1 || context.cancelled()) return {};
  ChangeSearch search{context, {}, {}};
  InnovationStage stage = settled(context, base, {}, kMostTurns, wide(context.options.threads));
  if (!std::isfinite(stage.minus_two_log)) return {};
  search.innovations.before = stage;
  if (motion_explains_more(stage)) return {};
  std::vector<ChangeScore> taken;
  while (taken.size() < kMostChanges && add_change(context, stage, search, taken)) {
  }
  if (search.changes.empty() || context.cancelled()) return {};
  const FitSummary& fitted = stage.model.fitted;
  const FitDataset& data = stage.context.problem.data;
  const Eigen::VectorXd errors = std_errors(data, data.all_mask, fitted);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    std::vector<std::string> rivals = std::move(search.changes[i].rivals);
    search.changes[i] = described(taken[i], fitted, errors);
    search.changes[i].rivals = std::move(rivals);
  }
  search.innovations.final = std::move(stage);
  weigh_remainder(search.context, search.innovations);
  if (search.innovations.physics_missing()) return {};
  return search;
}

}  // namespace estimator::greybox::selection
