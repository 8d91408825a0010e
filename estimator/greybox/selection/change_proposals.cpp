#include "estimator/greybox/selection/change_proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/greybox/selection/innovation_search.h"

namespace estimator::greybox::selection {
namespace {

/// Most changes that are fitted by their scores, and the share of the best score that they need.
constexpr std::size_t kFinalists = 6;
constexpr double kWorthFitting = 0.5;
/// Where a drift within the record is begun with, and a time constant, as shares of the record.
constexpr double kDriftBegins = 0.25;
constexpr double kDriftLasts = 0.4;
constexpr double kDriftSettles = 0.2;
/// Time constants in the length of the ramp that an exponential looks like.
constexpr double kConstantsOfRamp = 2.5;
/// Range of a changed plant parameter about the present value, in logarithms.
constexpr double kRange = 2.3;
/// Scale that a drift is begun with, in typical ones.
constexpr double kSmallScale = 0.1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A time within the record, counted from `start_s` so that difference quotients take a tenth of a
/// sample: a stiff rig answers a step within one.
FreeParameter time_parameter(const std::string& name, double start_s, const Dataset& record) {
  const double unit_s = 100.0 * record.sample_time_s;
  FreeParameter time{name, ParameterScale::linear, unit_s};
  time.origin = start_s;
  time.lower = time.to_theta(record.t_s.front());
  time.upper = time.to_theta(record.t_s.back());
  time.prior_sd = kInfinite;
  return time;
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

void add(ParameterSubset& all, const FreeParameter& parameter, double theta) {
  Eigen::VectorXd start(1);
  start[0] = std::clamp(theta, parameter.lower, parameter.upper);
  append(all, {{parameter}, start});
}

std::vector<ChangeScore> finalists(const InnovationStage& stage) {
  std::vector<ChangeScore> scores = change_scores(stage);
  if (scores.empty()) return {};
  const double least = std::max(kEvidence_nats, kWorthFitting * scores.front().gain_nats);
  std::erase_if(scores, [&](const ChangeScore& score) { return score.gain_nats < least; });
  scores.resize(std::min(scores.size(), kFinalists));
  return scores;
}

/// The size of an effect that the stage has, or that of one that is absent; no name where the plant
/// has no such effect.
ChangeScore score_of_effect(const InnovationStage& stage, const std::string& effect) {
  ChangeScore score;
  for (const plant_sim::EffectInfo& candidate : stage.context.problem.candidate_effects) {
    const std::vector<FreeParameter> sizes = effect_parameters(candidate, 0);
    if (candidate.name != effect || sizes.empty()) continue;
    score.parameter = sizes.front();
    score.absent = true;
  }
  for (const FreeParameter& own : stage.model.fitted.parameters) {
    if (effect_of(own) != effect) continue;
    score.parameter = own;
    score.absent = false;
    break;
  }
  return score;
}

/// Makes the change a ramp from the first sample to the last.
void set_throughout(ChangeScore& score, const Dataset& record) {
  score.kind = ChangeKind::ramp;
  score.at_s = record.t_s.front();
  score.duration_s = record.t_s.back() - record.t_s.front();
}

}  // namespace

std::vector<ChangeScore> drifts_of(const InnovationStage& stage) {
  std::vector<ChangeScore> scores;
  const Dataset& record = stage.context.problem.data.records.front();
  for (const char* effect : {"null_bias", "load_force"}) {
    ChangeScore score = score_of_effect(stage, effect);
    if (score.parameter.name.empty()) continue;
    set_throughout(score, record);
    scores.push_back(score);
    const double length_s = score.duration_s;
    score.at_s = record.t_s.front() + kDriftBegins * length_s;
    score.duration_s = kDriftLasts * length_s;
    scores.push_back(score);
    score.kind = ChangeKind::exponential;
    score.at_s = record.t_s.front();
    score.duration_s = kDriftSettles * length_s;
    scores.push_back(score);
  }
  return scores;
}

namespace {

/// A load or an offset that sets in: the innovations forget them at once, so that no score shows
/// them.
void add_jumps(const InnovationStage& stage, std::vector<ChangeScore>& scores) {
  const disturbance::ForceJump jump = likeliest_jump(stage);
  if (!(jump.gain_nats > kEvidence_nats)) return;
  for (const char* effect : {"load_force", "null_bias"}) {
    ChangeScore score = score_of_effect(stage, effect);
    if (score.parameter.name.empty()) continue;
    score.at_s = jump.time_s;
    score.gain_nats = jump.gain_nats;
    if (score.parameter.name == "load_force.force_N") score.by = jump.size / score.parameter.unit;
    scores.push_back(score);
  }
}

double error_of(const FitSummary& fitted, const Eigen::VectorXd& errors, const std::string& name) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (fitted.parameters[i].name == name)
      return errors[k] * fitted.parameters[i].slope(fitted.theta[k]);
  }
  return std::nan("");
}

}  // namespace

namespace {

/// A scale that drifts from the first sample to the last, about the middle of the motion and about
/// the sensor's zero: what an offset that drifts with it leaves hides it from a score.
void add_scales(const InnovationStage& stage, std::vector<ChangeScore>& scores) {
  for (const std::string& law : stage.context.problem.shown_by_change) {
    ChangeScore score = score_of_effect(stage, law);
    if (score.parameter.name.empty() || !score.absent) continue;
    score.zero_before = true;
    set_throughout(score, stage.context.problem.data.records.front());
    for (const double by : {kSmallScale, -kSmallScale}) {
      score.by = by;
      score.about_m.reset();
      scores.push_back(score);
      score.about_m = 0.0;
      scores.push_back(score);
    }
  }
}

}  // namespace

std::string name_of(const ChangeScore& score) {
  const std::string in = score.record.empty() ? "" : kInRecord + score.record;
  return "change." + score.parameter.name + in;
}

namespace {

/// The effect's other parameters, which are the same before and after its size changes.
void append_constants(const SearchContext& context, const ChangeScore& score,
                      ParameterSubset& all) {
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (effect.name != effect_of(score.parameter)) continue;
    for (const FreeParameter& other : effect_parameters(effect, kEveryRefinement)) {
      if (other.name != score.parameter.name)
        add(all, other, score.about_m ? other.to_theta(*score.about_m) : 0.0);
    }
  }
}

}  // namespace

ChangeProposal proposal(const SearchContext& plain, const InnovationStage& stage,
                        const ChangeScore& score) {
  const Dataset& record = plain.problem.data.records.front();
  ChangeProposal made{plain, stage.model, score};
  plant_sim::Change change{.parameter = score.parameter.name, .at_s = score.at_s};
  const FitSummary& fitted = stage.model.fitted;
  ParameterSubset all = subset(fitted, [](const auto&) { return true; });
  double theta = 0.0;
  if (score.zero_before) {
    append_constants(plain, score, all);
  } else if (score.absent) {
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
  const double begin_s = record.t_s.front();
  const double end_s = record.t_s.back();
  const bool whole = score.duration_s >= end_s - begin_s;
  if (score.kind == ChangeKind::exponential) {
    change.time_constant_s = score.duration_s;
    add(all,
        duration_parameter(name_of(score) + ".time_constant_s", score.duration_s,
                           10.0 * record.sample_time_s, 10.0 * (end_s - begin_s)),
        0.0);
    if (score.at_s > begin_s) {
      add(all, time_parameter(name_of(score) + ".at_s", score.at_s, record), 0.0);
    }
  } else if (!whole) {
    add(all, time_parameter(name_of(score) + ".at_s", score.at_s, record), 0.0);
  }
  if (score.kind == ChangeKind::ramp) {
    change.ramp_s = score.duration_s;
    if (!whole) {
      add(all,
          duration_parameter(name_of(score) + ".ramp_s", score.duration_s,
                             4.0 * record.sample_time_s, end_s - begin_s),
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

std::vector<ChangeScore> change_candidates(const InnovationStage& stage) {
  std::vector<ChangeScore> scores = finalists(stage);
  add_jumps(stage, scores);
  for (ChangeScore& drift : drifts_of(stage)) scores.push_back(std::move(drift));
  add_scales(stage, scores);
  // a record has one change of a parameter
  std::erase_if(scores, [&](const ChangeScore& score) {
    const auto& known = stage.context.problem.model.changes;
    return std::any_of(known.begin(), known.end(), [&](const plant_sim::Change& change) {
      return change.parameter == score.parameter.name;
    });
  });
  return scores;
}

ChangeScore ramp_throughout(const ChangeScore& exponential, const FitSummary& fitted,
                            const Dataset& record) {
  ChangeScore ramp = exponential;
  set_throughout(ramp, record);
  const std::string own = name_of(exponential);
  const double time_constant_s = fitted.value(own + ".time_constant_s");
  const double reached = -std::expm1(-ramp.duration_s / time_constant_s);
  const double from = fitted.value(exponential.parameter.name);
  const double begun = std::isfinite(from) ? from : exponential.unfitted_value();
  const double end = begun + reached * (fitted.value(own + ".value") - begun);
  const double by = exponential.parameter.to_theta(end) - exponential.parameter.to_theta(begun);
  if (std::isfinite(by)) ramp.by = by;
  return ramp;
}

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

ChangeScore settling_from(const ChangeScore& ramp, const FitSummary& fitted) {
  ChangeScore settling = ramp;
  settling.kind = ChangeKind::exponential;
  settling.at_s = fitted.value(name_of(ramp) + ".at_s");
  settling.duration_s = fitted.value(name_of(ramp) + ".ramp_s") / kConstantsOfRamp;
  return settling;
}

ChangeScore with_course_of(const ChangeScore& change, const FitSummary& fitted,
                           const ChangeScore& other) {
  ChangeScore result = other;
  result.kind = change.kind;
  const auto fitted_or = [&](const char* name, double otherwise) {
    const double value = fitted.value(name_of(change) + name);
    return std::isfinite(value) ? value : otherwise;
  };
  result.at_s = fitted_or(".at_s", change.at_s);
  result.duration_s = fitted_or(".ramp_s", fitted_or(".time_constant_s", change.duration_s));
  return result;
}

ChangeScore step_within(const ChangeScore& course, const FitSummary& fitted) {
  ChangeScore step = course;
  const std::string own = name_of(course);
  const double begins_s = fitted.value(own + ".at_s");
  const double to_middle_s = course.kind == ChangeKind::ramp
                                 ? 0.5 * fitted.value(own + ".ramp_s")
                                 : fitted.value(own + ".time_constant_s");
  step.kind = ChangeKind::step;
  step.duration_s = 0.0;
  step.at_s = (std::isfinite(begins_s) ? begins_s : course.at_s) + to_middle_s;
  return step;
}

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
  change.is_dated = std::isfinite(fitted.value(own + ".at_s"));
  change.at_error_s = error_of(fitted, errors, own + ".at_s");
  change.duration_s = change.kind == ChangeKind::step ? 0.0
                      : change.kind == ChangeKind::ramp
                          ? value_or(own + ".ramp_s", score.duration_s)
                          : value_or(own + ".time_constant_s", score.duration_s);
  change.from = value_or(change.parameter, score.unfitted_value());
  change.from_error = error_of(fitted, errors, change.parameter);
  change.to = fitted.value(own + ".value");
  change.to_error = error_of(fitted, errors, own + ".value");
  return change;
}

}  // namespace estimator::greybox::selection
