#include "estimator/greybox/selection/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "config/schema/joined.h"
#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/excitation.h"
#include "estimator/greybox/selection/final_parameters.h"
#include "estimator/greybox/selection/indistinguishable_models.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/localisation.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// The fitted model's error over the noise from which on the record itself is looked at.
constexpr double kFarFromFloor = 10.0;
/// A disturbance that would cause this many times the error that there is has not been understood,
/// where a curve gains this much beside it. Friction and play let less of it through than their
/// linearised models.
constexpr double kIncredible = 1.5;
constexpr double kSuspicious_nats = 15.0;
/// Share of the motion from which on the error is no disturbance's: the model does not follow.
constexpr double kLost = 0.5;
/// Size of a law over its standard error, from which on it is learned.
constexpr double kClearOfError = 3.0;
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

/// Held-out error of a simulation, its parameters fitted to such.
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
  result.whole = localise(context, first);
  result.where = result.whole;
  if (final.added.empty()) return;
  result.where_is_whole = true;
  if (final.added.size() >= kStandIn) return;
  std::vector<Localisation> left = localise(context, final);
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

/// RMS of the position about its mean.
double motion_rms_m(const FitDataset& data) {
  double square_m2 = 0.0;
  std::size_t samples = 0;
  for (const Dataset& record : data.records) {
    const Eigen::Map<const Eigen::ArrayXd> y_m(record.y_m.data(),
                                               static_cast<Eigen::Index>(record.size()));
    square_m2 += (y_m - y_m.mean()).square().sum();
    samples += record.size();
  }
  return std::sqrt(square_m2 / static_cast<double>(samples));
}

void take_errors(Diagnosis& result) {
  result.nominal_rms_m = result.search.nominal_rms_m;
  list_steps(result);
  result.rms_before_m = result.steps.front().validation_rms_m;
  result.rms_after_m = result.search.final.fitted.validation_rms_m;
  result.missing = result.search.final.added;
}

/// A verdict by the held-out errors of simulations.
void conclude(const SearchContext& context, const SearchContext& search, Diagnosis& result) {
  const ModelStage found = result.search.final;
  if (uses_segments(search, context)) {
    refit_to_whole(context, result.search);
    result.searched_s = length_s(search.problem.data);
  }
  take_errors(result);
  const ModelStage& final = result.search.final;
  result.repetition =
      repeated_motion((result.searched_s ? context : search).problem.data, final.fitted.residual_m);
  fit_final_parameters(context, result);
  if (final.fitted.validation_rms_m > kUnexplained * result.noise_floor_m) {
    result.verdict = Verdict::unexplained;
    list_free_runs(search, result);
    const bool begun = !result.search.rounds.empty();
    localise_remainder(search, begun ? result.search.rounds.front().before : found, found, result);
    classify_indistinguishable(search, found, result);
  } else {
    classify_indistinguishable(search, found, result);
    result.verdict = final.added.empty()        ? Verdict::nothing_missing
                     : result.ambiguous.empty() ? Verdict::missing
                                                : Verdict::undetermined;
  }
}

ParameterStep load_step(const InnovationSearch& innovations) {
  const bool force = innovations.final.linear.front().force;
  const std::string name = force ? "load_force.force_N" : "speed_mps";
  const double held = innovations.final.model.fitted.value(name);
  const double from = std::isfinite(held) ? held : 0.0;
  return {name, innovations.jump.time_s, from, from + innovations.jump.size};
}

/// A load that sets in is all there is where no curve is left; seen from outside it may look like
/// anything that goes with time.
void locate_load(const InnovationSearch& innovations, std::vector<Localisation>& where) {
  std::erase_if(where, [](const Localisation& one) { return one.variable != "time"; });
  const std::string site = innovations.final.linear.front().force ? "force" : "flow";
  for (Localisation& one : where) one.site = site;
}

/// A verdict by the likelihood of innovations.
void conclude(const SearchContext& context, const SearchContext& search, const ModelStage& first,
              const InnovationSearch& innovations, Diagnosis& result) {
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
  take_errors(result);
  result.repetition = repeated_motion(search.problem.data, result.search.final.fitted.residual_m);
  // missing physics passes for a disturbance as long as it is not in the model
  if (!context.cancelled()) result.disturbance = disturbance_of(search, innovations);
  const bool incredible = result.disturbed_floor_m() > kIncredible * result.rms_after_m &&
                          innovations.curve_nats > kSuspicious_nats + innovations.inexact_nats;
  const bool lost = result.rms_after_m > kLost * motion_rms_m(search.problem.data);
  const bool physics = innovations.physics_missing() || incredible || lost;
  if (result.floor_assumed) result.noise_floor_m = innovations.final.noise.noise.sensor_m;
  result.curve_nats = innovations.curve_nats;
  result.innovations = static_cast<double>(innovations.final.model.fitted.residual_m.size());
  result.gains_nats = innovations.gains_nats;
  if (physics) {
    // the noise model passes for what is missing: it must not weigh what the values have to explain
    result.disturbance.reset();
    list_free_runs(search, result);
    for (std::size_t i = 0; i < innovations.without.size(); ++i) {
      result.without_rms_m[result.missing[i]] =
          least_rms_m(search, innovations.without[i].model.fitted, kObserver_per_s);
    }
    fit_final_parameters(search, result);
  } else {
    take_parameters(innovations.final, result);
  }
  for (const InnovationRivals& rivals : find_rivals(search, innovations)) {
    const Separable& separable = search.options.separable;
    const bool separates =
        search.cancelled() || (separable && separable(search, rivals.explanations, rivals.names));
    (separates ? result.ambiguous : result.same_here).push_back(rivals.names);
  }
  // effects taken for want of the right one hide it: the model as given shows it more clearly
  if (physics) {
    result.where = result.whole = localise(search, first);
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

/// What was known before any conclusion was drawn.
Diagnosis begun(const Diagnosis& result) {
  Diagnosis begun;
  begun.noise_floor_m = result.noise_floor_m;
  begun.floor_assumed = result.floor_assumed;
  begun.excitation = result.excitation;
  begun.command_lead_samples = result.command_lead_samples;
  begun.checks = result.checks;
  begun.search.nominal_rms_m = result.search.nominal_rms_m;
  begun.search.preview_s = result.search.preview_s;
  return begun;
}

/// How a law enters, in the words of a Localisation.
std::string class_of(const Law& law) {
  if (law.effect.site == "force") return "force";
  if (law.effect.site == "sensor") return "measurement";
  return law.effect.site == "leakage" || law.effect.site == "flow" ? "flow" : "gain";
}

/// Concludes with laws where each is clear of its error and they leave clearly less than `before`.
bool take_laws(const SearchContext& context, const ModelStage& first, const LawSearch& found,
               const Diagnosis& before, Diagnosis& result) {
  Diagnosis learned = begun(before);
  conclude(found.context, found.context, first, found.innovations, learned);
  const auto is_size = [&](const ParameterValue& p) {
    return std::any_of(found.laws.begin(), found.laws.end(), [&](const Law& law) {
      return p.name == law.effect.name + "." + law.effect.parameters.front().name;
    });
  };
  for (const ParameterValue& p : learned.parameters) {
    if (!is_size(p)) continue;
    if (p.at_bound || !(std::abs(p.value) > kClearOfError * p.std_error)) return false;
  }
  if (learned.verdict == Verdict::unexplained) return false;
  learned.verdict = Verdict::learned;
  learned.laws = found.laws;
  std::vector<Localisation> where;
  const double explained = 1.0 - std::pow(learned.rms_after_m / learned.rms_before_m, 2);
  for (const Law& law : found.laws)
    where.push_back({class_of(law), law.variables.front(), explained});
  for (const Localisation& other : before.whole) {
    const bool known = std::any_of(where.begin(), where.end(), [&](const Localisation& one) {
      return one.site == other.site && one.variable == other.variable;
    });
    if (!known) where.push_back(other);
  }
  learned.where = std::move(where);
  learned.where_is_whole = true;
  plant_sim::ModelFile model = context.problem.model;
  for (const Law& law : found.laws) model.declare(law.effect, "dictionary of laws");
  learned.better = with_values(model, learned.final);
  result = std::move(learned);
  return true;
}

/// Laws of the dictionary, where no effect explains the record and they leave clearly less.
void learn_laws(const SearchContext& context, const ModelStage& first, Diagnosis& result) {
  const std::optional<LawSearch> found = search_laws(context, first, "");
  if (!found) return;
  Diagnosis learned;
  if (take_laws(context, first, *found, result, learned) &&
      learned.rms_after_m < (1.0 - kRivals) * result.rms_after_m) {
    result = std::move(learned);
  }
}

/// A law at the site of the one effect found, where it is clearly likelier than the effect: under a
/// disturbance the nearest effect passes for a law that the library does not have.
bool prefer_law(const SearchContext& context, const ModelStage& first,
                const InnovationSearch& innovations, Diagnosis& result) {
  const InnovationStage& named = innovations.final;
  if (named.model.added.size() != 1 || innovations.physics_missing()) return false;
  const plant_sim::EffectInfo* effect = plant_sim::find_effect(named.model.added.front());
  if (effect == nullptr || effect->sites.size() != 1) return false;
  const std::optional<LawSearch> found = search_laws(context, first, effect->sites.front());
  return found && found->laws.size() == 1 &&
         penalised(found->innovations.final) < penalised(named) - 2.0 * kEvidence_nats &&
         take_laws(context, first, *found, result, result);
}

/// The search by innovations, and that by simulations where the former leaves physics unexplained.
void weigh_innovations(const SearchContext& context, const SearchContext& search, SearchStart start,
                       Diagnosis& result) {
  const ModelStage first = start.first;
  const InnovationSearch innovations = search_innovations(search, first, start.branch);
  result.search = abandon_search(search, start);
  if (innovations.final.linear.empty()) {  // no likelihood
    result.search = complete_search(search, std::move(start));
    conclude(context, search, result);
    return;
  }
  const auto take_innovations = [&] {
    if (!innovations.physics_missing()) {
      refuse(start.branch.stage, Refusal::unlikely, start.first, result.search);
    }
    conclude(context, search, first, innovations, result);
  };
  if (context.cancelled() || !innovations.physics_missing() || innovations.load_sets_in()) {
    if (!prefer_law(search, first, innovations, result)) take_innovations();
    return;
  }
  const FitSummary held = simulated(search, innovations.final.model.fitted);
  if (held.validation_rms_m <= kUnexplained * search.problem.data.noise_floor_m) {
    result.search = structure_search_of(search, first, innovations);
    conclude(context, search, result);
    return;
  }
  extend_search(search, start);
  // Prefers the model that leaves less, of equals the likelier.
  const auto leaves_more = [&](const ModelStage& stage) {
    return !is_explained(search, stage) &&
           (1.0 - kRivals) * held.validation_rms_m < stage.fitted.validation_rms_m;
  };
  if (leaves_more(start.branch.stage)) {
    take_innovations();
    return;
  }
  StructureSearch full = conclude_search(search, start);
  if (leaves_more(full.final)) {
    result.search.refused = std::move(full.refused);
    conclude(context, search, first, innovations, result);
  } else {
    result.search = std::move(full);
    conclude(context, search, result);
  }
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::nothing_missing:
      return "nothing_missing";
    case Verdict::missing:
      return "missing";
    case Verdict::undetermined:
      return "undetermined";
    case Verdict::learned:
      return "learned";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::not_excited:
      break;
  }
  return "not_excited";
}

std::vector<std::string> Diagnosis::established() const {
  std::vector<std::string> names = missing;
  std::erase_if(names, [&](const std::string& name) {
    return std::any_of(possible.begin(), possible.end(),
                       [&](const PossibleEffect& one) { return one.effect == name; }) ||
           std::any_of(laws.begin(), laws.end(),
                       [&](const Law& law) { return law.effect.name == name; });
  });
  return names;
}

double Diagnosis::disturbed_floor_m() const {
  return disturbance ? std::hypot(noise_floor_m, disturbance->rms_m) : noise_floor_m;
}

Diagnosis diagnose(const DiagnosisProblem& problem, const DiagnosisOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  SearchContext context{problem, options};
  Diagnosis result;
  result.floor_assumed = !std::isfinite(problem.data.noise_floor_m);
  assume_noise_floor(context.problem.data);
  result.noise_floor_m = context.problem.data.noise_floor_m;
  result.excitation = excitation_of(context.problem.data);
  if (!result.excitation.sufficient()) {
    result.verdict = Verdict::not_excited;
    result.better = problem.model;
    return result;
  }
  SearchContext search = for_search(context);
  SearchStart start = start_search(search);
  if (!is_explained(search, start.branch.stage) || !floor_shows_lead(search.problem.data)) {
    const CommandLead lead = find_command_lead(search, start.branch.stage);
    if (lead.samples > 0.0 && !context.cancelled()) {
      advance_command(context.problem.data, lead.samples);
      context.problem.interpolated_nats = lead.gain_nats;
      search = for_search(context);
      start = start_search(search);
      result.command_lead_samples = lead.samples;
    }
  }
  const ModelStage first = start.first;
  if (first.fitted.validation_rms_m > kFarFromFloor * result.noise_floor_m) {
    result.checks = check_records(search, first.fitted.validation_rms_m);
  }
  const bool wrong_record = result.checks && result.checks->turned_sign();
  if (context.cancelled()) {
    result.search = conclude_search(search, std::move(start));
    conclude(context, search, result);
  } else if (wrong_record) {
    result.search = abandon_search(search, start);
    conclude(context, search, result);
  } else if (is_explained(search, start.branch.stage)) {
    result.search = complete_search(search, std::move(start));
    conclude(context, search, result);
  } else {
    weigh_innovations(context, search, std::move(start), result);
  }
  if (result.verdict == Verdict::unexplained && !wrong_record && !context.cancelled()) {
    learn_laws(search, first, result);
  }
  if (result.checks && result.verdict == Verdict::unexplained && !wrong_record) {
    result.plants = fit_other_plants(search);
  }
  result.possible = possible_effects(result);
  result.runtime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace estimator::greybox::selection
