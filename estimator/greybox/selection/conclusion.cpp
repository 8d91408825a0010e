#include "estimator/greybox/selection/conclusion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "config/schema/joined.h"
#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/final_parameters.h"
#include "estimator/greybox/selection/indistinguishable_models.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/noise_credibility.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/prediction_error.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Share of the error that other effects leave, below which these are no matter of the noise.
constexpr double kDisputed = 0.6;
/// Share of the squared error that a place has to explain to be named.
constexpr double kNamesAPlace = 0.05;
constexpr double kAsClear = 0.9;  ///< ratio of the remainder's explained share to that of the whole

void list_steps(Diagnosis& result) {
  std::size_t known = 0;
  for (const ModelStage& stage : result.search.path) {
    const std::vector<std::string> added(
        stage.added.begin() + static_cast<std::ptrdiff_t>(std::min(known, stage.added.size())),
        stage.added.end());
    known = stage.added.size();
    result.steps.push_back({config::schema::joined(added, " + "), stage.fitted.validation_rms_m});
  }
}

/// The observer hides much of a constant or slow effect.
void list_free_runs(const SearchContext& context, Diagnosis& result) {
  in_parallel(result.steps.size(), context.options.threads, [&](std::size_t i) {
    result.steps[i].free_run_rms_m = least_rms_m(context, result.search.path[i].fitted, 0.0);
  });
}

/// Localises the unexplained residual. The model as given shows more clearly what effects taken in
/// place of the right one have absorbed. A bundle of effects is such a stand-in.
void localise_remainder(const SearchContext& context, const ModelStage& first,
                        const ModelStage& final, Diagnosis& result) {
  result.whole = places_of(context, first);
  result.where = result.whole;
  if (final.added.empty()) return;
  result.where_is_whole = true;
  if (final.added.size() >= kStandIn) return;
  std::vector<Localisation> left = places_of(context, final);
  const auto share = [](const std::vector<Localisation>& where) {
    return where.empty() ? 0.0 : where.front().explained_ratio;
  };
  if (!(share(left) >= kAsClear * share(result.whole))) return;
  result.where = std::move(left);
  result.where_is_whole = false;
}

/// Groups that a motion could separate make the verdict undetermined; other groups are equivalent.
void classify_indistinguishable(const SearchContext& context, const ModelStage& found,
                                Diagnosis& result) {
  for (const IndistinguishableModels& models :
       find_indistinguishable(context, result.search.rounds, found)) {
    std::vector<std::string> group{models.found};
    group.insert(group.end(), models.others.begin(), models.others.end());
    const Separable& separable = context.options.separable;
    const bool separates =
        context.cancelled() || (separable && separable(context, models.explanations, group));
    (separates ? result.ambiguous : result.same_here).push_back(std::move(group));
  }
}

/// True where the sizes of all effects of the better model are within their errors.
bool are_all_within_errors(const Diagnosis& result) {
  const std::vector<PossibleEffect> possible = possible_effects(result);
  return !possible.empty() && possible.size() == result.missing.size() &&
         std::all_of(possible.begin(), possible.end(),
                     [](const auto& one) { return one.why == Doubt::within_error; });
}

void take_errors(const SearchContext& search, Diagnosis& result) {
  result.nominal_rms_m = result.search.nominal_rms_m;
  list_steps(result);
  result.rms_before_m = result.steps.front().validation_rms_m;
  result.rms_after_m = result.search.final.fitted.validation_rms_m;
  result.fitted_rms_m = fitted_rms_m(search.problem.data, result.search.final.fitted);
  result.missing = result.search.final.added;
}

}  // namespace

double least_rms_m(const SearchContext& context, const FitSummary& fitted, double observer_per_s) {
  constexpr int kIterations = 15;
  constexpr double kTolerance = 1e-3;
  FitOptions options;
  options.max_iterations = kIterations;
  options.tolerance = kTolerance;
  options.final_jacobian = false;
  options.observer_per_s = observer_per_s;
  options.cancel = context.options.cancel;
  return fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
             fitted.parameters, fitted.theta, options)
      .validation_rms_m;
}

std::vector<Localisation> places_of(const SearchContext& context, const ModelStage& stage) {
  std::vector<Localisation> where = localise(context, stage);
  std::erase_if(where,
                [](const Localisation& one) { return !(one.explained_ratio > kNamesAPlace); });
  return where;
}

Diagnosis begun(const Diagnosis& result) {
  Diagnosis begun;
  begun.noise_floor_m = result.noise_floor_m;
  begun.floor_assumed = result.floor_assumed;
  begun.in_file = result.in_file;
  begun.excitation = result.excitation;
  begun.searched_s = result.searched_s;
  begun.command_lead_samples = result.command_lead_samples;
  begun.checks = result.checks;
  begun.search.nominal_rms_m = result.search.nominal_rms_m;
  begun.search.preview_s = result.search.preview_s;
  return begun;
}

void conclude(const SearchContext& context, const SearchContext& search, Diagnosis& result) {
  const Diagnosis before = result;
  const ModelStage found = result.search.final;
  if (uses_segments(search, context)) {
    refit_to_whole(context, result.search);
    result.searched_s = length_s(search.problem.data);
  }
  take_errors(result.searched_s ? context : search, result);
  const ModelStage& final = result.search.final;
  result.repetition =
      repeated_motion((result.searched_s ? context : search).problem.data, final.fitted.residual_m);
  fit_final_parameters(context, result);
  if (final.fitted.validation_rms_m > kUnexplained * result.noise_floor_m ||
      result.fitted_rms_m > kFittedToo * result.noise_floor_m) {
    result.verdict = Verdict::unexplained;
    list_free_runs(search, result);
    const bool begun = !result.search.rounds.empty();
    if (!(result.checks && result.checks->misread())) {
      localise_remainder(search, begun ? result.search.rounds.front().before : found, found,
                         result);
    }
    classify_indistinguishable(search, found, result);
  } else {
    classify_indistinguishable(search, found, result);
    result.verdict = final.added.empty()        ? Verdict::nothing_missing
                     : result.ambiguous.empty() ? Verdict::missing
                                                : Verdict::undetermined;
    const ModelStage& base = result.search.path.front();
    if (!context.cancelled() && !result.searched_s && base.added.empty() &&
        is_explained(search, base) && result.ambiguous.empty() && are_all_within_errors(result) &&
        chance(search, base.fitted, final.fitted) > kChance) {
      ModelStage bare = base;
      result = before;
      result.search.path = {bare};
      result.search.final = std::move(bare);
      conclude(context, search, result);
    }
  }
}

namespace {

ParameterChange load_step(const InnovationSearch& innovations) {
  const bool force = innovations.final.linear.front().force;
  const std::string name = force ? "load_force.force_N" : "speed_mps";
  const double held = innovations.final.model.fitted.value(name);
  const double from = std::isfinite(held) ? held : 0.0;
  ParameterChange change;
  change.parameter = name;
  change.at_s = innovations.jump.time_s;
  change.from = from;
  change.to = from + innovations.jump.size;
  return change;
}

/// A load that sets in is all there is where no curve is left; seen from outside it may look like
/// anything that goes with time.
void locate_load(const InnovationSearch& innovations, std::vector<Localisation>& where) {
  std::erase_if(where, [](const Localisation& one) { return one.variable != "time"; });
  const std::string site = innovations.final.linear.front().force ? "force" : "flow";
  for (Localisation& one : where) {
    one.site = site;
    one.or_sites.clear();
  }
}

/// True where simulations had found other effects that leave far less, on held-out data, of a rod
/// that oil holds in place: a random force does not choose between them so.
bool is_disputed(const SearchContext& search, const InnovationSearch& innovations,
                 const Diagnosis& result) {
  const ModelStage& final = innovations.final.model;
  const bool held = result.disturbance && result.disturbance->as == "force" &&
                    !(rms_of_drive_N(search, final.fitted) > 0.0);
  const std::vector<RefusedModel>& refused = result.search.refused;
  return held && !final.added.empty() &&
         std::any_of(refused.begin(), refused.end(), [&](const RefusedModel& other) {
           return other.why == Refusal::unlikely &&
                  other.validation_rms_m < kDisputed * result.rms_after_m;
         });
}

/// True for an effect without parameters, or of size zero and without a refinement to act by.
bool is_nothing(const FitSummary& fitted, const std::string& effect) {
  const bool is_empty = std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                                     [&](const auto& p) { return belongs_to(p, effect); });
  if (is_empty) return true;
  return is_idle(fitted, effect) &&
         std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                      [&](const auto& p) { return belongs_to(p, effect) && p.refinement > 0; });
}

/// The search without an effect that the final fit has brought to nothing, where there is one.
std::optional<InnovationSearch> without_idle_effect(const SearchContext& search,
                                                    const InnovationSearch& innovations,
                                                    const FitSummary& final) {
  const std::vector<std::string>& added = innovations.final.model.added;
  for (std::size_t i = 0; i < innovations.without.size(); ++i) {
    if (!is_nothing(final, added[i])) continue;
    InnovationSearch rest = innovations;
    const InnovationStage& less = innovations.without[i];
    rest.final =
        settled(search, less.model, less.noise, Settling::fully, wide(search.options.threads));
    rest.without.clear();
    rest.rivals.clear();
    rest.gains_nats.erase(added[i]);
    rest.undriven.erase(added[i]);
    weigh_remainder(search, rest);
    return rest;
  }
  return {};
}

/// Effects whose rivals are sought: those that gain little beside what physics is missing are not
/// established anyway.
std::vector<std::string> effects_with_rivals(const InnovationSearch& innovations,
                                             const Diagnosis& result) {
  std::vector<std::string> effects = innovations.final.model.added;
  if (!innovations.physics_missing()) return effects;
  std::erase_if(effects, [&](const auto& name) { return !is_clear_of_remainder(result, name); });
  return effects;
}

}  // namespace

void conclude(const SearchContext& context, const SearchContext& search, const ModelStage& first,
              const InnovationSearch& innovations, Diagnosis& result) {
  const Diagnosis before = result;
  result.by_innovations = true;
  if (uses_segments(search, context)) result.searched_s = length_s(search.problem.data);
  const double nominal_m = result.search.nominal_rms_m;
  const double preview_s = result.search.preview_s;
  std::vector<RefusedModel> refused = std::move(result.search.refused);
  result.search = structure_search_of(search, first, innovations);
  std::erase_if(refused, [&](const RefusedModel& model) {
    return model.effects == result.search.final.added ||
           model.validation_rms_m >
               (1.0 - kWorthTelling) * result.search.final.fitted.validation_rms_m;
  });
  result.search.refused = std::move(refused);
  result.search.nominal_rms_m = nominal_m;
  result.search.preview_s = preview_s;
  result.search.interrupted = search.cancelled();
  take_errors(search, result);
  result.repetition = repeated_motion(search.problem.data, result.search.final.fitted.residual_m);
  // missing physics passes for a disturbance as long as it is not in the model
  if (!context.cancelled()) result.disturbance = disturbance_of(search, innovations);
  result.noise_floor_m = sensor_noise_m(search, innovations, result.floor_assumed);
  const bool physics =
      innovations.physics_missing() || is_disputed(search, innovations, result) ||
      (!context.cancelled() &&
       !noise_is_credible(search, innovations, result.noise_floor_m, result.disturbance,
                          whole_rms_m(search, result.search.final.fitted)));
  result.loses_motion = !physics && loses_motion(search, innovations, result.disturbance);
  if (result.disturbance) limit(*result.disturbance, result.rms_after_m);
  result.curve_nats = innovations.curve_nats;
  result.innovations = static_cast<double>(innovations.final.model.fitted.residual_m.size());
  result.gains_nats = innovations.gains_nats;
  result.undriven = innovations.undriven;
  if (physics) {
    // the noise model passes for what is missing: it must not weigh what the values have to explain
    result.disturbance.reset();
    list_free_runs(search, result);
    for (std::size_t i = 0; i < innovations.without.size(); ++i) {
      result.without_rms_m[result.missing[i]] =
          least_rms_m(search, innovations.without[i].model.fitted, kObserver_per_s);
    }
    fit_final_parameters(search, result);
    if (const auto rest = without_idle_effect(search, innovations, result.final)) {
      result = before;
      conclude(context, search, first, *rest, result);
      return;
    }
  } else {
    if (result.disturbance && !context.cancelled())
      add_line_rivals(without_holdouts(search), innovations.final, *result.disturbance);
    if (!context.cancelled()) result.prediction = prediction_errors(search, innovations);
    take_parameters(innovations.final, result);
    if (result.has_coarse_step_beside(result.noise_floor_m))
      drop_step_error(result.disturbance, result.step_error_m);
    keep_file_where_better(search, result);
  }
  for (const InnovationRivals& rivals :
       find_rivals(search, innovations, effects_with_rivals(innovations, result))) {
    const Separable& separable = search.options.separable;
    const bool separates =
        search.cancelled() || (separable && separable(search, rivals.explanations, rivals.names));
    (separates ? result.ambiguous : result.same_here).push_back(rivals.names);
  }
  // effects taken for want of the right one hide it: the model as given shows it more clearly
  if (physics) {
    result.whole = places_of(search, first);
    result.where = result.whole;
    result.where_is_whole = true;
  }
  if (innovations.load_sets_in()) {
    result.changing = {load_step(innovations)};
    locate_load(innovations, result.where);
  }
  result.verdict = result.search.interrupted || physics ? Verdict::unexplained
                   : result.missing.empty()             ? Verdict::nothing_missing
                   : result.ambiguous.empty()           ? Verdict::missing
                                                        : Verdict::undetermined;
}

}  // namespace estimator::greybox::selection
