#include "estimator/greybox/selection/record_differences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "estimator/greybox/selection/change_proposals.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostDifferences = 3;
/// Share of what effects have explained that may be owed to their being inexact.
constexpr double kInexactRecords = 0.005;
/// Differences of a round that are fitted.
constexpr std::size_t kFittedDifferences = 6;
/// Range of a plant parameter about its value in the other records, in logarithms.
constexpr double kDifferenceRange = 2.3;

struct Differences {
  SearchContext context;
  InnovationSearch innovations;
  InnovationStage stage;
  std::vector<ChangeScore> scores;
  std::vector<ParameterChange> changes;
};

std::string parameter_of(const ChangeScore& score) {
  return score.parameter.name + kInRecord + score.record;
}

/// The model with the parameter free in the record, where the score expects it.
ModelStage with_difference(const ModelStage& stage, const ChangeScore& score) {
  FreeParameter own = score.parameter;
  const auto known = std::find_if(stage.fitted.parameters.begin(), stage.fitted.parameters.end(),
                                  [&](const FreeParameter& p) { return p.name == own.name; });
  const bool absent = known == stage.fitted.parameters.end();
  const double shared = absent ? own.to_theta(score.unfitted_value())
                               : stage.fitted.theta[known - stage.fitted.parameters.begin()];
  own.name = parameter_of(score);
  own.prior_sd = std::numeric_limits<double>::infinity();
  if (own.scale == ParameterScale::logarithmic) {
    own.lower = shared - kDifferenceRange;
    own.upper = shared + kDifferenceRange;
  }
  ModelStage next = stage;
  ParameterSubset all = subset(next.fitted, [](const auto&) { return true; });
  append(all, {{own},
               Eigen::VectorXd::Constant(1, std::clamp(shared + score.by, own.lower, own.upper))});
  next.fitted.parameters = std::move(all.parameters);
  next.fitted.theta = std::move(all.start);
  next.added.push_back(name_of(score));
  return next;
}

/// Of two records either may be said to differ: the one that leaves the other nearer to the file.
/// `best`: the likeliest.
std::size_t nearest_to_file(const SearchContext& context, const std::vector<ChangeScore>& scores,
                            const std::vector<InnovationStage>& stages, std::size_t best) {
  const std::string& name = scores[best].parameter.name;
  const std::vector<FreeParameter>& plant = context.problem.plant_parameters;
  const auto known = std::find_if(plant.begin(), plant.end(),
                                  [&](const FreeParameter& p) { return p.name == name; });
  if (known == plant.end()) return best;
  const double file = start_of(context.problem.model, plant)[known - plant.begin()];
  const auto distance = [&](std::size_t i) {
    const FitSummary& fitted = stages[i].model.fitted;
    for (std::size_t k = 0; k < fitted.parameters.size(); ++k) {
      if (fitted.parameters[k].name == name)
        return std::abs(fitted.theta[static_cast<Eigen::Index>(k)] - file);
    }
    return std::numeric_limits<double>::infinity();
  };
  std::size_t nearest = best;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const bool same = scores[i].parameter.name == name &&
                      penalised(stages[i]) < penalised(stages[best]) + 2.0 * kRivals_nats;
    if (same && distance(i) < distance(nearest)) nearest = i;
  }
  return nearest;
}

/// The stage with the likeliest difference; false where none is worth it.
bool add_difference(Differences& found) {
  const SearchContext& context = found.context;
  std::vector<ChangeScore> scores = record_scores(found.stage);
  std::erase_if(scores, [](const ChangeScore& s) { return !(s.gain_nats > kEvidence_nats); });
  scores.resize(std::min(scores.size(), kFittedDifferences));
  std::vector<InnovationStage> stages(scores.size());
  in_parallel(scores.size(), context.options.threads, [&](std::size_t i) {
    if (context.cancelled()) return;
    SearchContext with_gains = found.stage.context;
    ModelStage model = with_difference(found.stage.model, scores[i]);
    model.fitted = fit_innovations(with_gains, {model.fitted.parameters, model.fitted.theta},
                                   SimulationWidth{}, InnovationFit::trial);
    stages[i] =
        settled(context, std::move(model), found.stage.noise, Settling::once, SimulationWidth{});
  });
  const auto likeliest =
      std::min_element(stages.begin(), stages.end(),
                       [](const auto& a, const auto& b) { return penalised(a) < penalised(b); });
  if (likeliest == stages.end() || context.cancelled()) return false;
  const std::size_t chosen = nearest_to_file(context, scores, stages,
                                             static_cast<std::size_t>(likeliest - stages.begin()));
  const InnovationStage* const best = &stages[chosen];
  InnovationStage next =
      settled(context, best->model, best->noise, Settling::fully, wide(context.options.threads));
  if (!(next.minus_two_log < best->minus_two_log)) next = *best;
  const double gain_nats = 0.5 * (penalised(found.stage) - penalised(next));
  if (!(gain_nats > kEvidence_nats)) return false;
  ParameterChange change;
  change.parameter = scores[chosen].parameter.name;
  change.kind = ChangeKind::record;
  change.record = scores[chosen].record;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const bool close = penalised(stages[i]) <= penalised(*best) + 2.0 * kEvidence_nats;
    if (i != chosen && close && scores[i].parameter.name != change.parameter)
      change.rivals.push_back(scores[i].parameter.name);
  }
  InnovationCandidate candidate;
  candidate.effect = name_of(scores[chosen]);
  candidate.settled = true;
  candidate.penalty_nats = penalty_nats(next.model.fitted, found.stage.model.fitted);
  candidate.gain_nats = gain_nats;
  candidate.fitted = next.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  found.innovations.gains_nats[candidate.effect] = gain_nats;
  InnovationRound round{found.stage.model, {std::move(candidate)}, true};
  round.before.fitted.jacobian.resize(0, 0);
  found.innovations.rounds.push_back(std::move(round));
  found.changes.push_back(std::move(change));
  found.scores.push_back(scores[chosen]);
  found.stage = std::move(next);
  return true;
}

std::optional<Differences> search_differences(const SearchContext& context,
                                              const InnovationStage& base) {
  Differences found{context, {}, base, {}, {}};
  found.innovations.before = base;
  while (found.changes.size() < kMostDifferences && add_difference(found)) {
  }
  if (found.changes.empty() || context.cancelled()) return {};
  add_lines(context, found.innovations, found.stage);
  found.innovations.final = found.stage;
  weigh_remainder(context, found.innovations);
  return found;
}

/// Values and errors of the differences, from the final parameters.
void describe(const std::vector<ParameterValue>& values, Differences& found) {
  const auto value_of = [&](const std::string& name) {
    return std::find_if(values.begin(), values.end(),
                        [&](const ParameterValue& p) { return p.name == name; });
  };
  for (std::size_t i = 0; i < found.changes.size(); ++i) {
    ParameterChange& change = found.changes[i];
    const auto to = value_of(parameter_of(found.scores[i]));
    const auto from = value_of(change.parameter);
    change.at_s = std::nan("");
    change.duration_s = std::nan("");
    change.from = from == values.end() ? found.scores[i].unfitted_value() : from->value;
    if (from != values.end()) change.from_error = from->std_error;
    if (to != values.end()) {
      change.to = to->value;
      change.to_error = to->std_error;
    }
  }
}

}  // namespace

bool find_record_differences(const SearchContext& with_holdouts, const ModelStage& first,
                             Diagnosis& result) {
  if (with_holdouts.problem.data.fitted_records < 2 || with_holdouts.cancelled()) return false;
  SearchContext context = without_holdouts(with_holdouts);
  const ModelStage named = result.search.final;
  const SimulationWidth width = wide(context.options.threads);
  const InnovationStage plain = settled(context, first, {}, Settling::fully, width);
  const InnovationStage before =
      named.added.empty() ? plain : settled(context, named, {}, Settling::fully, width);
  if (!std::isfinite(plain.minus_two_log) || !std::isfinite(before.minus_two_log)) return false;
  std::optional<Differences> found = search_differences(context, before);
  if (!named.added.empty() && result.verdict != Verdict::nothing_missing) {
    // effects found while a difference was not known may stand for it
    std::optional<Differences> alone = search_differences(context, plain);
    if (alone &&
        (!found || penalised(alone->stage) < penalised(found->stage) + 2.0 * kEvidence_nats))
      found = std::move(alone);
  }
  if (!found) return false;
  const double explained_nats = 0.5 * (plain.minus_two_log - before.minus_two_log);
  const double enough_nats = kEvidence_nats + kInexactRecords * std::max(0.0, explained_nats);
  if (!(penalised(found->stage) < penalised(before) - 2.0 * enough_nats)) return false;
  SearchContext concluding = with_holdouts;
  concluding.problem.candidate_effects.clear();
  Diagnosis changed = begun(result);
  conclude(concluding, concluding, first, found->innovations, changed);
  if (changed.verdict == Verdict::unexplained ||
      !(changed.rms_after_m < (1.0 - kWorthwhile) * result.rms_after_m)) {
    return false;
  }
  describe(changed.parameters, *found);
  std::erase_if(changed.parameters, [](const ParameterValue& p) {
    return p.name.find(kInRecord) != std::string::npos;
  });
  std::erase_if(changed.missing,
                [](const std::string& name) { return name.starts_with("change."); });
  changed.verdict = Verdict::changing;
  changed.changing = std::move(found->changes);
  result = std::move(changed);
  return true;
}

}  // namespace estimator::greybox::selection
