#include "estimator/greybox/selection/dated_changes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/drift_starts.h"
#include "estimator/greybox/selection/effects_beside_change.h"
#include "estimator/greybox/selection/innovation_search.h"

namespace estimator::greybox::selection {
namespace {

/// The error goes with the time, which comes first; the change that explains it is its place.
void locate_change(std::vector<Localisation>& where) {
  std::stable_partition(where.begin(), where.end(),
                        [](const Localisation& one) { return one.variable == "time"; });
  for (Localisation& one : where) one.or_sites.clear();
}

/// The values of the changes with the errors of the final parameters.
void take_final_errors(Diagnosis& changed) {
  const auto error_of = [&](const std::string& name, double& error) {
    for (const ParameterValue& p : changed.parameters) {
      if (p.name == name) error = p.std_error;
    }
  };
  for (ParameterChange& change : changed.changing) {
    error_of(change.parameter, change.from_error);
    error_of("change." + change.parameter + ".value", change.to_error);
  }
}

/// True where the changes found explain the record and leave clearly less than `before`.
bool take_changes(const ModelStage& first, ChangeSearch& found, const Diagnosis& before,
                  Diagnosis& result) {
  const std::vector<std::string>& added = found.innovations.final.model.added;
  const auto is_change = [](const std::string& name) { return name.starts_with("change."); };
  if (std::all_of(added.begin(), added.end(), is_change)) {
    found.context.problem.candidate_effects.clear();  // none of them alone explains the record
  }
  for (const std::string& name : added) {
    if (is_change(name)) found.innovations.rivals[name] = {};  // these are the change's own
  }
  Diagnosis changed = begun(before);
  conclude(found.context, found.context, first, found.innovations, changed);
  if (changed.verdict == Verdict::unexplained ||
      !(changed.rms_after_m < (1.0 - kRivals) * before.rms_after_m)) {
    return false;
  }
  changed.verdict = Verdict::changing;
  // an effect that changes is named with its change; what the file lacks of it is another matter
  const auto is_lacking = [&](const std::string& name) {
    return changed.is_in_file(name) &&
           std::any_of(changed.parameters.begin(), changed.parameters.end(),
                       [&](const ParameterValue& p) {
                         return !p.in_model && p.name.starts_with(name + ".") &&
                                !changes_parameter(found.changes, p.name);
                       });
  };
  std::erase_if(changed.missing, [&](const std::string& name) {
    return is_change(name) || (!is_lacking(name) && changes_effect(found.changes, name));
  });
  changed.changing = found.changes;
  take_final_errors(changed);
  if (!std::all_of(changed.changing.begin(), changed.changing.end(), is_clear_of_errors)) {
    return false;
  }
  changed.where = before.where;
  changed.where_is_whole = true;
  locate_change(changed.where);
  result = std::move(changed);
  return true;
}

/// Changes beside an effect where that was taken for a change; none where they do not explain the
/// record: what hardly changes is no change to be stated.
void prefer_effects(const SearchContext& context, const ModelStage& first, ChangesSought sought,
                    FoundChanges& changes) {
  if (!changes.explaining || context.cancelled()) return;
  const std::optional<ModelStage> steady = steady_effect(first, *changes.explaining);
  if (!steady) return;
  FoundChanges others = search_changes(context, *steady, sought);
  if (!others.explaining) {  // beside the effect the motion may explain more than time, or less
    const bool before = sought == ChangesSought::before_laws;
    others = search_changes(context, *steady,
                            before ? ChangesSought::after_laws : ChangesSought::before_laws);
  }
  changes.explaining = others.explaining;
}

/// Takes changes beside the model as given, `result.search`, where they leave less than `most_m`.
bool take_early(const SearchContext& context, const ModelStage& first, ChangeSearch& changes,
                double most_m, Diagnosis& result) {
  Diagnosis without = begun(result);
  without.search = result.search;
  conclude(context, context, without);
  Diagnosis dated = result;
  if (!take_changes(first, changes, without, dated) || !(dated.rms_after_m < most_m)) return false;
  result = std::move(dated);
  return true;
}

/// True where a change is that of a parameter among the drifts'.
bool has_one_of(const std::vector<ChangeProposal>& drifts,
                const std::vector<ParameterChange>& changes) {
  return std::any_of(changes.begin(), changes.end(), [&](const ParameterChange& change) {
    return std::any_of(drifts.begin(), drifts.end(), [&](const ChangeProposal& drift) {
      return drift.score.parameter.name == change.parameter;
    });
  });
}

}  // namespace

bool date_changes(const SearchContext& context, const ModelStage& first,
                  const ModelStage& likeliest, Diagnosis& result, ChangesSought sought) {
  std::vector<ModelStage> bases{first};
  for (const ModelStage& found : {result.search.final, likeliest}) {
    const bool known = found.added == bases.back().added;
    if (!known && found.added.size() < kStandIn) bases.push_back(found);
  }
  std::optional<ModelStage> beside;
  for (const ModelStage& base : bases) {
    FoundChanges changes = search_changes(context, base, sought);
    prefer_effects(context, first, sought, changes);
    if (changes.explaining && take_changes(first, *changes.explaining, result, result)) return true;
    if (base.added.empty() && changes.likeliest) beside = effects_beside(first, *changes.likeliest);
  }
  if (!beside) return false;
  FoundChanges changes = search_changes(context, *beside, sought);
  return changes.explaining && take_changes(first, *changes.explaining, result, result);
}

bool date_drifts(const SearchContext& context, const ModelStage& first, double most_m,
                 Diagnosis& result) {
  const std::vector<ChangeProposal> drifts = drift_starts(context, first, most_m);
  if (drifts.empty() || context.cancelled()) return false;
  FoundChanges changes = search_changes(context, first, ChangesSought::before_laws, drifts);
  prefer_effects(context, first, ChangesSought::before_laws, changes);
  if (!changes.explaining || !has_one_of(drifts, changes.explaining->changes)) return false;
  return take_early(context, first, *changes.explaining, most_m, result);
}

bool date_changes_early(const SearchContext& context, const ModelStage& first,
                        const InnovationStage& stage, const ModelStage& held, Diagnosis& result) {
  FoundChanges changes = search_changes(context, first, ChangesSought::before_laws);
  prefer_effects(context, first, ChangesSought::before_laws, changes);
  if (!changes.explaining || context.cancelled() ||
      !is_clearly_likelier(context, changes.explaining->innovations.final, stage, held)) {
    return false;
  }
  return take_early(context, first, *changes.explaining, held.fitted.validation_rms_m, result);
}

}  // namespace estimator::greybox::selection
