#include "estimator/greybox/selection/indistinguishable_models.h"

#include <algorithm>

#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::VectorXd;

/// Largest number of effects in a group.
constexpr std::size_t kLargestGroup = 3;
/// Ratio to the chosen candidate's error up to which candidates of a round may become rivals with
/// all other effects in place.
constexpr double kWorthARefit = 2.0;
constexpr std::size_t kMostRefits = 4;
/// Least share of the found effect's gain that a rival brings.
constexpr double kShareOfGain = 0.5;
/// Share of the error up to which the difference of two residuals counts as the same motion.
constexpr double kSameMotion = 0.3;

/// The last round that tried the effect: the one with most of the other effects in place.
const Round* round_of(const std::vector<Round>& rounds, const std::string& effect) {
  const auto has_tried = [&](const Round& round) {
    const auto& before = round.before.added;
    return std::find(before.begin(), before.end(), effect) == before.end() &&
           std::any_of(round.candidates.begin(), round.candidates.end(), [&](const auto& one) {
             return one.fitted_at_all && one.effects == std::vector<std::string>{effect};
           });
  };
  const auto last = std::find_if(rounds.rbegin(), rounds.rend(), has_tried);
  return last == rounds.rend() ? nullptr : &*last;
}

/// The final model with `candidate` instead of `effect`.
FitSummary replaced(const SearchContext& context, const ModelStage& final,
                    const std::string& effect, const Candidate& candidate) {
  ParameterSubset selection =
      subset(final.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
  const ParameterSubset own = subset(
      candidate.fitted, [&](const auto& p) { return belongs_to(p, candidate.effects.front()); });
  append(selection, own);
  return refit_if_hopeful(context, selection, final.fitted.validation_rms_m);
}

bool contains(const SearchContext& context, const FitSummary& larger, const FitSummary& smaller) {
  if (larger.parameters.size() <= smaller.parameters.size()) return false;
  const double apart_m = rms(larger.residual_m - smaller.residual_m, context.problem.data.all_mask);
  return apart_m < kSameMotion * smaller.validation_rms_m;
}

bool explains_alike(const SearchContext& context, const FitSummary& found,
                    const FitSummary& other) {
  return other.validation_rms_m <= (1.0 + kRivals) * found.validation_rms_m &&
         chance(context, other, found) > kTold && !contains(context, other, found);
}

bool brings_enough(double without_m, const FitSummary& found, const FitSummary& other) {
  const double gain = 1.0 - found.validation_rms_m / without_m;
  const double other_gain = 1.0 - other.validation_rms_m / without_m;
  return other_gain >= kShareOfGain * gain;
}

}  // namespace

std::vector<IndistinguishableModels> find_indistinguishable(const SearchContext& context,
                                                            const std::vector<Round>& rounds,
                                                            const ModelStage& final) {
  std::vector<IndistinguishableModels> result;
  for (const std::string& effect : final.added) {
    const Round* round = round_of(rounds, effect);
    if (round == nullptr || context.cancelled()) continue;
    double chosen_m = 0.0;
    for (const Candidate& candidate : round->candidates) {
      if (candidate.effects == std::vector<std::string>{effect})
        chosen_m = candidate.validation_rms_m;
    }
    std::vector<const Candidate*> others;
    for (const Candidate& candidate : round->candidates) {
      const bool taken = std::find(final.added.begin(), final.added.end(),
                                   candidate.effects.front()) != final.added.end();
      if (candidate.effects.size() > 1 || taken || !candidate.fitted_at_all ||
          candidate.validation_rms_m > kWorthARefit * chosen_m || others.size() >= kMostRefits) {
        continue;
      }
      others.push_back(&candidate);
    }
    std::vector<FitSummary> fits(others.size());
    in_parallel(others.size(), context.options.threads,
                [&](std::size_t i) { fits[i] = replaced(context, final, effect, *others[i]); });
    if (std::none_of(fits.begin(), fits.end(), [&](const FitSummary& fit) {
          return explains_alike(context, final.fitted, fit);
        })) {
      continue;
    }
    const double without_m =
        final.added.size() == 1 && round->before.added.empty()
            ? round->before.fitted.validation_rms_m
            : refit(context,
                    subset(final.fitted, [&](const auto& p) { return !belongs_to(p, effect); }),
                    context.problem.data.training_mask)
                  .validation_rms_m;
    IndistinguishableModels group{effect, {}, {final.fitted}};
    for (std::size_t i = 0; i < fits.size() && group.others.size() + 1 < kLargestGroup; ++i) {
      if (!explains_alike(context, final.fitted, fits[i]) ||
          !brings_enough(without_m, final.fitted, fits[i])) {
        continue;
      }
      group.others.push_back(others[i]->effects.front());
      group.explanations.push_back(std::move(fits[i]));
    }
    if (!group.others.empty()) result.push_back(std::move(group));
  }
  return result;
}

}  // namespace estimator::greybox::selection
