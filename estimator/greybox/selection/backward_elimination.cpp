#include "estimator/greybox/selection/backward_elimination.h"

#include <algorithm>
#include <set>

#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/further_refinements.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Iterations of a fit that only has to show whether it ends lower.
constexpr int kFirstIterations = 10;

bool costs_little(const SearchContext& context, const FitSummary& without, const FitSummary& with) {
  return without.validation_rms_m <
         (1.0 + worthwhile_at(context, with.validation_rms_m)) * with.validation_rms_m;
}

/// Fits of several subsets in parallel, each stopped when clearly worse than the stage.
std::vector<FitSummary> fitted(const SearchContext& context, const ModelStage& stage,
                               const std::vector<ParameterSubset>& subsets) {
  std::vector<FitSummary> fits(subsets.size());
  in_parallel(subsets.size(), context.options.threads, [&](std::size_t i) {
    fits[i] = refit_if_hopeful(context, subsets[i], stage.fitted.validation_rms_m);
  });
  return fits;
}

void drop_effects(const SearchContext& context, ModelStage& stage) {
  bool dropped = true;
  while (dropped && stage.added.size() > 1 && !context.cancelled()) {
    dropped = false;
    std::vector<ParameterSubset> subsets;
    for (const std::string& effect : stage.added) {
      subsets.push_back(
          subset(stage.fitted, [&](const auto& p) { return !belongs_to(p, effect); }));
    }
    std::vector<FitSummary> without = fitted(context, stage, subsets);
    for (std::size_t i = 0; i < without.size() && !dropped && !context.cancelled(); ++i) {
      if (!costs_little(context, without[i], stage.fitted)) continue;
      stage.fitted = std::move(without[i]);
      stage.added.erase(stage.added.begin() + static_cast<std::ptrdiff_t>(i));
      dropped = true;
    }
  }
}

/// Refinements of an effect that are in the search, the last first; none where one is all of it.
std::set<int, std::greater<>> refinements_of(const FitSummary& fitted, const std::string& effect) {
  std::set<int, std::greater<>> refinements;
  bool has_size = false;
  for (const FreeParameter& p : fitted.parameters) {
    if (!belongs_to(p, effect)) continue;
    if (p.refinement > 0) refinements.insert(p.refinement);
    has_size = has_size || p.refinement == 0;
  }
  if (!has_size && refinements.size() == 1) refinements.clear();
  return refinements;
}

ParameterSubset without_refinement(const FitSummary& fitted, const std::string& effect,
                                   int refinement) {
  return subset(
      fitted, [&](const auto& p) { return !belongs_to(p, effect) || p.refinement != refinement; });
}

struct Refinement {
  std::string effect;
  int number = 0;
};

/// Refinements of all effects of a stage, in the order of removal.
std::vector<Refinement> refinements_of(const ModelStage& stage) {
  std::vector<Refinement> all;
  for (const std::string& effect : stage.added) {
    for (const int number : refinements_of(stage.fitted, effect)) all.push_back({effect, number});
  }
  return all;
}

bool earned(const SearchContext& context, CrossValidation& halves, const ModelStage& stage,
            const ParameterSubset& plain, const FitSummary& without) {
  return !costs_little(context, without, stage.fitted) &&
         (is_explained(context, stage) ||
          halves.holds(false, plain, subset(stage.fitted, [](const auto&) { return true; })));
}

void drop_refinements(const SearchContext& context, CrossValidation& halves, ModelStage& stage) {
  drop_idle_refinements(stage.added, stage.fitted);
  drop_empty_effects(stage.added, stage.fitted);
  std::vector<Refinement> remaining = refinements_of(stage);
  while (!remaining.empty() && !context.cancelled()) {
    std::vector<ParameterSubset> plain;
    plain.reserve(remaining.size());
    for (const Refinement& refinement : remaining) {
      plain.push_back(without_refinement(stage.fitted, refinement.effect, refinement.number));
    }
    std::vector<FitSummary> without = fitted(context, stage, plain);
    std::size_t i = 0;
    while (i < remaining.size() && !context.cancelled() &&
           earned(context, halves, stage, plain[i], without[i])) {
      ++i;
    }
    if (i == remaining.size() || context.cancelled()) return;
    stage.fitted = refit_to_convergence(context, without[i]);
    drop_empty_effects(stage.added, stage.fitted);
    remaining.erase(remaining.begin(), remaining.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
}

void add_refinements(const SearchContext& context, CrossValidation& halves, ModelStage& stage) {
  for (const std::string& effect : stage.added) {
    for (const auto& refinement : further_refinements(context, stage.fitted, effect)) {
      const ParameterSubset plain = subset(stage.fitted, [](const auto&) { return true; });
      const ParameterSubset more = refined(stage.fitted, refinement);
      if (!halves.holds(is_explained(context, stage), plain, more)) continue;
      stage.fitted =
          refit(context, more, context.problem.data.training_mask, wide(context.options.threads));
    }
  }
}

}  // namespace

void refit_without_refinements(const SearchContext& context, ModelStage& stage) {
  std::vector<ParameterSubset> without;
  for (const Refinement& refinement : refinements_of(stage)) {
    without.push_back(without_refinement(stage.fitted, refinement.effect, refinement.number));
  }
  stage.fitted = refit_to_convergence(context, stage.fitted);
  if (is_explained(context, stage) || without.empty() || context.cancelled()) return;
  FitOptions begin;
  begin.max_iterations = kFirstIterations;
  begin.final_jacobian = false;
  begin.cancel = context.options.cancel;
  if (without.size() == 1) begin.width = wide(context.options.threads);
  std::vector<FitSummary> fits(without.size());
  in_parallel(without.size(), context.options.threads, [&](std::size_t i) {
    fits[i] = fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
                  without[i].parameters, without[i].start, begin);
  });
  const auto best = std::min_element(fits.begin(), fits.end(), [](const auto& a, const auto& b) {
    return a.validation_rms_m < b.validation_rms_m;
  });
  if (best->validation_rms_m >= stage.fitted.validation_rms_m) return;
  stage.fitted = refit_to_convergence(context, *best);  // full convergence after the removal
}

void eliminate_backward(const SearchContext& context, CrossValidation& halves, ModelStage& stage,
                        EliminationPass look) {
  drop_effects(context, stage);
  if (look == EliminationPass::intermediate && !is_explained(context, stage)) return;
  drop_refinements(context, halves, stage);
  add_refinements(context, halves, stage);
}

}  // namespace estimator::greybox::selection
