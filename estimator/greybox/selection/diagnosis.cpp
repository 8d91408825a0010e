#include "estimator/greybox/selection/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimator/greybox/selection/excitation.h"
#include "estimator/greybox/selection/indistinguishable_models.h"
#include "estimator/greybox/selection/localisation.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kAsClear = 0.9;  ///< explained share of what is left over that of the whole

/// The better model's parameters on all samples, with what the record says of each.
void settle(const Workshop& shop, Diagnosis& result) {
  const Stage& stage = result.ladder.final;
  const Selection all = select(stage.fitted, [](const auto&) { return true; });
  const bool explained = stage.fitted.score_rms_m <= kUnexplained * shop.evidence.noise_floor_m;
  // what is left of the error is no noise: then the values are those that simulate best
  result.final = shop.cancelled() ? stage.fitted
                 : explained      ? refit(shop, all, shop.evidence.finally(), shop.threads)
                                  : refit(shop, all, shop.evidence.finally(), shop.threads, 0.0);
  result.better = with_values(shop.model, result.final);
  const Eigen::VectorXd errors = std_errors(shop.evidence, shop.evidence.finally(), result.final);
  for (std::size_t i = 0; i < result.final.searched.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const SearchParameter& p = result.final.searched[i];
    const bool at_bound = result.final.at_bound[i] != 0;
    const double error = at_bound ? std::nan("") : errors[k] * p.slope(result.final.x[k]);
    result.parameters.push_back({p.name, p.value(result.final.x[k]), error, at_bound});
  }
}

void list_steps(Diagnosis& result) {
  for (const Stage& stage : result.ladder.way) {
    result.steps.push_back(
        {stage.added.empty() ? "" : stage.added.back(), stage.fitted.score_rms_m});
  }
}

/// What carries the residual that nothing explains. Effects that were taken for want of the right
/// one have swallowed part of it: then the model as given shows it more clearly.
std::vector<Where> carriers(const Workshop& shop, const Stage& first, const Stage& final) {
  std::vector<Where> left = localise(shop, final);
  if (final.added.empty()) return left;
  std::vector<Where> whole = localise(shop, first);
  const auto share = [](const std::vector<Where>& where) {
    return where.empty() ? 0.0 : where.front().explained_ratio;
  };
  return share(left) >= kAsClear * share(whole) ? left : whole;
}

/// Groups that a motion could separate make the verdict undetermined; others are the same equation.
void weigh_rivals(const Workshop& shop, const Stage& found, const Separable& separable,
                  Diagnosis& result) {
  for (const Rivalry& rivalry : rivalries(shop, result.ladder.rounds, found)) {
    std::vector<std::string> group{rivalry.found};
    group.insert(group.end(), rivalry.others.begin(), rivalry.others.end());
    const bool separates = separable(shop, rivalry.explanations, group);
    (separates ? result.ambiguous : result.same_here).push_back(std::move(group));
  }
}

}  // namespace

const char* text(Verdict verdict) {
  switch (verdict) {
    case Verdict::nothing_missing:
      return "nothing_missing";
    case Verdict::missing:
      return "missing";
    case Verdict::undetermined:
      return "undetermined";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::not_excited:
      break;
  }
  return "not_excited";
}

Diagnosis diagnose(const Workshop& shop, const Separable& separable) {
  const auto begin = std::chrono::steady_clock::now();
  Diagnosis result;
  result.noise_floor_m = shop.evidence.noise_floor_m;
  for (const Measured& record : shop.evidence.records) {
    for (const std::string& note : record.notes) result.notes.push_back(record.name + ": " + note);
  }
  const Excitation excitation = excitation_of(shop.evidence);
  if (!excitation.enough) {
    result.verdict = Verdict::not_excited;
    result.notes.push_back(excitation.why);
    result.better = shop.model;
    return result;
  }
  const Workshop search = for_search(shop);
  result.ladder = climb(search);
  const Stage found = result.ladder.final;
  if (searches_in_part(search, shop)) {
    carry_to_whole(shop, result.ladder);
    result.notes.push_back(note_of_search(search, shop));
  }
  const Stage& final = result.ladder.final;
  result.nominal_rms_m = result.ladder.nominal_rms_m;
  list_steps(result);
  result.rms_before_m = result.steps.front().score_rms_m;
  result.rms_after_m = final.fitted.score_rms_m;
  result.missing = final.added;
  settle(shop, result);
  if (final.fitted.score_rms_m > kUnexplained * result.noise_floor_m) {
    result.verdict = Verdict::unexplained;
    const bool begun = !result.ladder.rounds.empty();
    result.where = carriers(search, begun ? result.ladder.rounds.front().before : found, found);
    weigh_rivals(search, found, separable, result);
  } else {
    weigh_rivals(search, found, separable, result);
    result.verdict = final.added.empty()        ? Verdict::nothing_missing
                     : result.ambiguous.empty() ? Verdict::missing
                                                : Verdict::undetermined;
  }
  if (result.ladder.interrupted) result.notes.emplace_back("interrupted: the best so far");
  result.runtime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace estimator::greybox::selection
