#include "estimator/greybox/selection/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/dated_changes.h"
#include "estimator/greybox/selection/disturbance_report.h"
#include "estimator/greybox/selection/excitation.h"
#include "estimator/greybox/selection/explained_beyond_effects.h"
#include "estimator/greybox/selection/innovation_rivals.h"
#include "estimator/greybox/selection/learned_laws.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/noise_credibility.h"
#include "estimator/greybox/selection/other_file_values.h"
#include "estimator/greybox/selection/other_readings.h"
#include "estimator/greybox/selection/record_differences.h"
#include "estimator/greybox/selection/screening_memo.h"
#include "estimator/greybox/selection/search_beginning.h"
#include "estimator/greybox/selection/settled_memo.h"
#include "estimator/greybox/selection/simulated_laws.h"
#include "estimator/greybox/selection/step_error.h"

namespace estimator::greybox::selection {
namespace {

/// The fitted model's error over the noise from which on the record itself is looked at.
constexpr double kFarFromFloor = 10.0;
/// Rise of a simulation's held-out error that a disturbance, of which a record has few periods,
/// does not cause by chance.
constexpr double kClearlyWorse = 0.25;
/// The same over the error that the disturbance causes on average, where nothing else is missing: a
/// slow one moves an axis for long.
constexpr double kSlowDisturbance = 0.6;
/// Periods of a disturbance's corner in the record, below which it may be a drift.
constexpr double kPeriodsOfDrift = 4.0;

constexpr const char* kTransportDelay = "transport_delay";
constexpr const char* kDelay = "transport_delay.delay_s";
/// Share of the command's lead from which on a delay takes it back.
constexpr double kUndone = 0.5;

/// Searches for laws before all effects have been tried, each beside other effects than before.
constexpr std::size_t kMostEarlySearches = 2;

/// True where a simulation whose parameters are fitted to it leaves less than `most_m`: what the
/// stage's own leaves beyond that is its disturbance's.
bool follows_motion(const SearchContext& search, const InnovationStage& stage, double most_m) {
  return least_rms_m(search, stage.model.fitted, kObserver_per_s) < most_m;
}

/// The search without its effects, where these leave a simulation worse on held-out data: what the
/// likelihood gains by them is a matter of the noise, not of the motion. Between errors that are
/// nearly the same, the disturbance in both decides.
void drop_worthless(const SearchContext& search, InnovationSearch& innovations) {
  if (innovations.final.model.added.empty()) return;
  if (loses_motion(search, innovations, disturbance_of(search, innovations))) return;
  const double with_m = simulated(search, innovations.final.model.fitted).validation_rms_m;
  // the model without effects, with the lines that were known before the first of them
  const auto plain_round =
      std::find_if(innovations.rounds.rbegin(), innovations.rounds.rend(),
                   [](const InnovationRound& round) { return round.before.added.empty(); });
  const FitSummary& without = plain_round == innovations.rounds.rend()
                                  ? innovations.before.model.fitted
                                  : plain_round->before.fitted;
  const double without_m = simulated(search, without).validation_rms_m;
  const double most_m = (1.0 + kClearlyWorse) * without_m;
  if (with_m < most_m) return;
  if (!innovations.physics_missing() && follows_motion(search, innovations.final, most_m)) return;
  InnovationSearch plain;
  plain.before = innovations.before;
  plain.final = std::move(innovations.before);
  weigh_remainder(search, plain);
  innovations = std::move(plain);
}

/// The search by innovations, and that by simulations where the former leaves physics unexplained.
/// `likeliest`: the model of the former, whichever is taken.
void weigh_innovations(const SearchContext& context, const SearchContext& search, SearchStart start,
                       Diagnosis& result, ModelStage& likeliest) {
  const ModelStage first = start.first;
  result.search = abandon_search(search, start);
  SearchLimits limits;
  std::vector<std::vector<std::string>> asked;  // effects beside which laws were sought
  bool learned = false;
  const auto ends_at = [&](const InnovationStage& stage, double inexact_nats) {
    const std::vector<std::string>& added = stage.model.added;
    if (asked.size() == kMostEarlySearches ||
        std::find(asked.begin(), asked.end(), added) != asked.end() ||
        !may_learn_early(search, stage, inexact_nats)) {
      return false;
    }
    asked.push_back(added);
    learned = learn_law_early(search, first, stage, start.branch.stage, result);
    return learned;
  };
  if (!search.problem.effects_only) limits.ends_at = ends_at;
  InnovationSearch innovations = search_innovations(search, first, start.branch, limits);
  if (learned) {
    if (uses_segments(search, context)) result.searched_s = length_s(search.problem.data);
    return;
  }
  if (innovations.final.linear.empty()) {  // no likelihood
    result.search = complete_search(search, std::move(start));
    conclude(context, search, result);
    return;
  }
  likeliest = innovations.final.model;
  drop_worthless(search, innovations);
  const auto take_innovations = [&] {
    if (!innovations.physics_missing()) {
      refuse(start.branch.stage, Refusal::unlikely, start.first, result.search);
    }
    conclude(context, search, first, innovations, result);
  };
  const FitSummary held = simulated(search, innovations.final.model.fitted);
  // the search by simulations has ended, that by the likelihood has not
  if (context.cancelled() &&
      start.branch.stage.fitted.validation_rms_m < kFarLess * held.validation_rms_m) {
    result.search = conclude_search(search, std::move(start));
    conclude(context, search, result);
    return;
  }
  // what the likelihood prefers is no better model where its simulation is the worse one, unless
  // the disturbance is as large: a fit of simulations follows that
  const std::optional<Disturbance> disturbance = disturbance_of(search, innovations);
  const double sensor_m = sensor_noise_m(search, innovations, result.floor_assumed);
  const bool understood =
      innovations.load_sets_in() ||
      (!innovations.physics_missing() &&
       noise_is_credible(search, innovations, sensor_m, disturbance, whole_rms_m(search, held)));
  const double floor_m = std::hypot(sensor_m, disturbance ? disturbance->rms_m : 0.0);
  const double expected_m =
      std::max((1.0 + kClearlyWorse) * first.fitted.validation_rms_m,
               (1.0 + (understood ? kSlowDisturbance : kClearlyWorse)) * floor_m);
  const bool worse = !(held.validation_rms_m <= expected_m) &&
                     !(understood && follows_motion(search, innovations.final, expected_m));
  if (context.cancelled() || (!worse && understood)) {
    if (!prefer_law(search, first, innovations, result) &&
        !prefer_curve(search, first, innovations, result)) {
      take_innovations();
    }
    return;
  }
  if (is_explained(search, {innovations.final.model.added, held})) {
    if (prefer_law(search, first, innovations, result)) return;
    StructureSearch found = structure_search_of(search, first, innovations);
    found.nominal_rms_m = result.search.nominal_rms_m;
    found.preview_s = result.search.preview_s;
    result.search = std::move(found);
    conclude(context, search, result);
    return;
  }
  extend_search(search, start);
  // Prefers the model that leaves less; of equals, neither of which explains the record, that of
  // fewer effects, and then the likelier.
  const auto leaves_more = [&](const ModelStage& stage) {
    const bool simpler = stage.added.size() < innovations.final.model.added.size();
    return !is_explained(search, stage) &&
           (simpler ? 1.0 + kRivals : 1.0 - kRivals) * held.validation_rms_m <
               stage.fitted.validation_rms_m;
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

/// True where the likelihood can do without one of the effects: a simulation starts from the
/// model's own state, and an effect may make up for another one.
bool can_do_without_one(const SearchContext& context, const InnovationStage& stage) {
  const std::vector<std::string>& added = stage.model.added;
  return std::any_of(added.begin(), added.end(), [&](const std::string& effect) {
    const InnovationStage less = without(context, stage, effect);
    return 0.5 * (penalised(less) - penalised(stage)) < kEvidence_nats;
  });
}

/// True where noise explains what a stage leaves, by its size. Where several effects may stand in
/// for one law, its course over the motion must be that of noise too, and each must be needed.
bool leaves_noise(const SearchContext& context, const ModelStage& stage) {
  if (!is_explained(context, stage)) return false;
  if (stage.added.size() < 2) return true;
  // once shows it where nothing is missing
  for (const Settling effort : {Settling::once, Settling::fully}) {
    if (context.cancelled()) return true;
    InnovationSearch search;
    search.final = settled(context, stage, {}, effort, wide(context.options.threads));
    if (!std::isfinite(search.final.minus_two_log)) return true;
    weigh_remainder(context, search);
    if (!search.physics_missing()) return !can_do_without_one(context, search.final);
  }
  return false;
}

/// Dates a drift that leaves far less than the effects found so far, and far from the noise.
bool find_drift(const SearchContext& search, const SearchStart& start, Diagnosis& result) {
  const double left_m = start.branch.stage.fitted.validation_rms_m;
  if (search.problem.effects_only || !(left_m > kFarFromFloor * search.problem.data.noise_floor_m))
    return false;
  result.search = abandon_search(search, start);
  return date_drifts(search, start.first, kFarLess * left_m, result);
}

/// True where the disturbance is so slow that it may be a drift of the rig.
bool drifts(const Diagnosis& result, const FitDataset& data) {
  return result.disturbance && result.disturbance->corner_Hz > 0.0 &&
         result.disturbance->corner_Hz * length_s(data) < kPeriodsOfDrift;
}

/// Seeks what differs between records, changes in time and laws, where effects leave something to
/// them.
void look_beyond_effects(const SearchContext& search, const ModelStage& first,
                         const ModelStage& likeliest, Diagnosis& result) {
  if (!search.cancelled()) (void)find_record_differences(search, first, result);
  if (result.verdict == Verdict::unexplained && !search.cancelled()) {
    std::optional<LawSearch> approximate;
    if (!date_changes(search, first, likeliest, result) &&
        !learn_laws(search, first, likeliest, approximate, result) &&
        !date_changes(search, first, likeliest, result, ChangesSought::after_laws) && approximate) {
      approximate_by_laws(search, first, *approximate, result);
    }
  }
  if (result.verdict == Verdict::nothing_missing && !search.cancelled() &&
      drifts(result, search.problem.data)) {
    (void)date_changes(search, first, likeliest, result);
  }
}

/// A command acts at the sample at which it is logged, or may act before.
enum class CommandTimes { as_logged, may_lead };

/// Seeks effects from the first on, then what else explains the record. `context` may get another
/// command or wider ranges.
void seek_effects(SearchContext& context, SearchContext search, SearchStart start,
                  CommandTimes times, Diagnosis& result) {
  continue_search(search, start);
  if (start.branch.stage.added.size() > 1) prefer_pair_to_physics(search, start);
  if (times == CommandTimes::may_lead)
    result.command_lead_samples = take_command_lead(context, search, start);
  if (prefer_other_file_values(search, start, context.problem) ||
      widen_file_values(search, start, context.problem)) {
    search = for_search(context);
  }
  const ModelStage first = start.first;
  if (!(first.fitted.validation_rms_m > kFarFromFloor * result.noise_floor_m))
    result.checks.reset();
  ModelStage likeliest;
  if (context.cancelled()) {
    result.search = conclude_search(search, std::move(start));
    conclude(context, search, result);
  } else if (explain_by_laws(search, start, result)) {
    if (uses_segments(search, context)) result.searched_s = length_s(search.problem.data);
    return;
  } else if (leaves_noise(search, start.branch.stage)) {
    result.search = complete_search(search, std::move(start));
    conclude(context, search, result);
  } else if (!find_drift(search, start, result)) {
    if (start.branch.stage.added.empty()) prefer_pair_to_physics(search, start);
    weigh_innovations(context, search, std::move(start), result, likeliest);
  }
  if (!context.problem.effects_only) look_beyond_effects(search, first, likeliest, result);
  if (result.checks && result.verdict == Verdict::unexplained) {
    result.plants = fit_other_plants(search);
  }
}

/// True where a delay takes back much of the command's lead: then the log is not at fault.
bool delay_undoes_lead(const Diagnosis& result, const FitDataset& data) {
  const double lead_s = result.command_lead_samples * data.sample_time_s;
  const std::vector<std::string>& added = result.missing;
  return lead_s > 0.0 && std::find(added.begin(), added.end(), kTransportDelay) != added.end() &&
         result.final.value(kDelay) > kUndone * lead_s;
}

/// Share of the error that a finer step has to leave at most where it does not explain the record.
constexpr double kFinerLeaves = 0.8;

/// The model as given, fitted. Where a finer integration step leaves clearly less, `context` and
/// `search` get it.
SearchStart fit_with_fine_step(SearchContext& context, SearchContext& search) {
  SearchStart start = fit_as_given(search);
  if (context.cancelled() || !may_be_step_error(search, start.first.fitted)) return start;
  const auto problem = with_finer_step(context.problem);
  if (!problem) return start;
  SearchContext finer{*problem, context.options, std::make_shared<SettledMemo>(),
                      std::make_shared<ScreeningMemo>()};
  SearchContext search_finer = for_search(finer);
  SearchStart again = fit_as_given(search_finer);
  if (again.first.fitted.validation_rms_m < kFinerLeaves * start.first.fitted.validation_rms_m) {
    context = std::move(finer);
    search = std::move(search_finer);
    start = std::move(again);
  }
  return start;
}

/// The diagnosis with the integration step of the problem's model, or a finer one.
Diagnosis diagnose_by_steps(const DiagnosisProblem& problem, const DiagnosisOptions& options) {
  SearchContext context{problem, options, std::make_shared<SettledMemo>(),
                        std::make_shared<ScreeningMemo>()};
  Diagnosis result;
  result.effects_only = problem.effects_only;
  result.in_file = names_of(lacking_refinements(problem.model));
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
  SearchStart start = fit_with_fine_step(context, search);
  begin_rounds(search, start);
  if (uses_segments(search, context)) result.searched_s = length_s(search.problem.data);
  result.search = abandon_search(search, start);
  if (start.first.fitted.validation_rms_m > kFarFromFloor * result.noise_floor_m)
    result.checks = checks_of_reading(search, start);
  if (result.checks && result.checks->misread()) {
    conclude(context, search, result);
  } else if (!explain_beyond_effects(search, start, result)) {
    const Diagnosis before = result;
    const SearchContext as_logged = context;
    seek_effects(context, std::move(search), std::move(start), CommandTimes::may_lead, result);
    if (delay_undoes_lead(result, context.problem.data) && !context.cancelled()) {
      result = before;
      context = as_logged;
      search = for_search(context);
      seek_effects(context, search, start_search(search), CommandTimes::as_logged, result);
    }
  }
  weigh_doubts(result);
  return result;
}

/// True for an unexplained or undetermined record, unless it has to be read otherwise first.
bool is_open(const Diagnosis& result) {
  if (result.checks && result.checks->misread()) return false;
  return result.verdict == Verdict::unexplained || result.verdict == Verdict::undetermined;
}

/// Diagnoses a record again with a finer step where it stays open and the step's error is no small
/// matter: stick-slip hides what is missing beside it, and an effect may stand for that error.
void refine_step(const DiagnosisProblem& problem, const DiagnosisOptions& options,
                 Diagnosis& result) {
  const auto is_cancelled = [&] { return options.cancel && options.cancel(); };
  if (!is_open(result) || !result.has_coarse_step() || is_cancelled()) return;
  DiagnosisProblem used = problem;
  used.model.step_s = result.better.step_s;
  const auto finer = with_finer_step(used);
  if (!finer) return;
  Diagnosis again = diagnose_by_steps(*finer, options);
  const bool misread = again.checks && again.checks->misread();
  const bool is_settled = !is_open(again) && !misread;
  if (again.search.interrupted || (!is_settled && is_cancelled())) return;
  if (is_settled || again.rms_after_m < kFinerLeaves * result.rms_after_m) {
    result = std::move(again);
  }
}

}  // namespace

Diagnosis diagnose(const DiagnosisProblem& problem, const DiagnosisOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Diagnosis result = diagnose_by_steps(problem, options);
  refine_step(problem, options, result);
  // what was not tried by then may do as well
  if (is_open(result) && options.cancel && options.cancel()) {
    result.search.interrupted = true;
    weigh_doubts(result);
  }
  result.runtime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace estimator::greybox::selection
