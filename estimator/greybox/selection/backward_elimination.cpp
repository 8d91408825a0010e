#include "estimator/greybox/selection/backward_elimination.h"

#include <algorithm>
#include <set>

#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Of a fit that only has to show whether it ends lower.
constexpr int kFirstIterations = 10;

bool costs_little(const Workshop& shop, const Fitted& without, const Fitted& with) {
  return without.score_rms_m < (1.0 + worthwhile_at(shop, with.score_rms_m)) * with.score_rms_m;
}

/// Selections fitted side by side, each given up when hopeless beside the stage.
std::vector<Fitted> fitted(const Workshop& shop, const Stage& stage,
                           const std::vector<Selection>& selections) {
  std::vector<Fitted> fits(selections.size());
  in_parallel(selections.size(), shop.threads, [&](std::size_t i) {
    fits[i] = refit_if_hopeful(shop, selections[i], stage.fitted.score_rms_m);
  });
  return fits;
}

void drop_effects(const Workshop& shop, Stage& stage) {
  bool dropped = true;
  while (dropped && stage.added.size() > 1 && !shop.cancelled()) {
    dropped = false;
    std::vector<Selection> selections;
    for (const std::string& effect : stage.added) {
      selections.push_back(
          select(stage.fitted, [&](const auto& p) { return !belongs(p, effect); }));
    }
    std::vector<Fitted> without = fitted(shop, stage, selections);
    for (std::size_t i = 0; i < without.size() && !dropped && !shop.cancelled(); ++i) {
      if (!costs_little(shop, without[i], stage.fitted)) continue;
      stage.fitted = std::move(without[i]);
      stage.added.erase(stage.added.begin() + static_cast<std::ptrdiff_t>(i));
      dropped = true;
    }
  }
}

/// Those of an effect that are searched, the last first.
std::set<int, std::greater<>> refinements_of(const Fitted& fitted, const std::string& effect) {
  std::set<int, std::greater<>> refinements;
  for (const SearchParameter& p : fitted.searched) {
    if (belongs(p, effect) && p.refinement > 0) refinements.insert(p.refinement);
  }
  return refinements;
}

Selection without_refinement(const Fitted& fitted, const std::string& effect, int refinement) {
  return select(fitted,
                [&](const auto& p) { return !belongs(p, effect) || p.refinement != refinement; });
}

struct Refinement {
  std::string effect;
  int number = 0;
};

/// The refinements of all effects of a stage, in the order in which they may go.
std::vector<Refinement> refinements_of(const Stage& stage) {
  std::vector<Refinement> all;
  for (const std::string& effect : stage.added) {
    for (const int number : refinements_of(stage.fitted, effect)) all.push_back({effect, number});
  }
  return all;
}

bool earned(const Workshop& shop, const Stage& stage, const Selection& plain,
            const Fitted& without) {
  return !costs_little(shop, without, stage.fitted) &&
         (is_explained(shop, stage) ||
          supported(shop, false, plain, select(stage.fitted, [](const auto&) { return true; })));
}

void drop_refinements(const Workshop& shop, Stage& stage) {
  std::vector<Refinement> remaining = refinements_of(stage);
  while (!remaining.empty() && !shop.cancelled()) {
    std::vector<Selection> plain;
    plain.reserve(remaining.size());
    for (const Refinement& refinement : remaining) {
      plain.push_back(without_refinement(stage.fitted, refinement.effect, refinement.number));
    }
    std::vector<Fitted> without = fitted(shop, stage, plain);
    std::size_t i = 0;
    while (i < remaining.size() && !shop.cancelled() && earned(shop, stage, plain[i], without[i])) {
      ++i;
    }
    if (i == remaining.size() || shop.cancelled()) return;
    stage.fitted = finished(shop, without[i]);
    remaining.erase(remaining.begin(), remaining.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
}

void add_refinements(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    const auto info = std::find_if(shop.absent.begin(), shop.absent.end(),
                                   [&](const auto& absent) { return absent.name == effect; });
    if (info == shop.absent.end()) continue;
    std::set<int> missing;
    const std::vector<SearchParameter> all = effect_parameters(*info, kEveryRefinement);
    for (const SearchParameter& p : all) {
      const bool there = std::any_of(stage.fitted.searched.begin(), stage.fitted.searched.end(),
                                     [&](const auto& q) { return q.name == p.name; });
      if (!there && p.refinement > kFirstRefinements) missing.insert(p.refinement);
    }
    for (const int refinement : missing) {
      const Selection plain = select(stage.fitted, [](const auto&) { return true; });
      Selection more = plain;
      for (const SearchParameter& p : all) {
        if (p.refinement == refinement) more.searched.push_back(p);
      }
      more.start = VectorXd::Zero(static_cast<Index>(more.searched.size()));
      more.start.head(plain.start.size()) = plain.start;
      if (!supported(shop, is_explained(shop, stage), plain, more)) continue;
      stage.fitted = refit(shop, more, shop.evidence.fits, shop.threads);
    }
  }
}

}  // namespace

void end_unhindered(const Workshop& shop, Stage& stage) {
  std::vector<Selection> without;
  for (const Refinement& refinement : refinements_of(stage)) {
    without.push_back(without_refinement(stage.fitted, refinement.effect, refinement.number));
  }
  stage.fitted = finished(shop, stage.fitted);
  if (is_explained(shop, stage) || without.empty() || shop.cancelled()) return;
  FitOptions begin;
  begin.max_iterations = kFirstIterations;
  begin.final_jacobian = false;
  begin.cancel = shop.cancel;
  const auto side_by_side = std::min(shop.threads, static_cast<unsigned>(without.size()));
  begin.threads = shop.threads / side_by_side;
  std::vector<Fitted> fits(without.size());
  in_parallel(without.size(), side_by_side, [&](std::size_t i) {
    fits[i] = fit(shop.model, shop.evidence, shop.evidence.fits, without[i].searched,
                  without[i].start, begin);
  });
  const auto best = std::min_element(fits.begin(), fits.end(), [](const auto& a, const auto& b) {
    return a.score_rms_m < b.score_rms_m;
  });
  if (best->score_rms_m >= stage.fitted.score_rms_m) return;
  stage.fitted = finished(shop, *best);  // from the ground up, now that nothing is in its way
}

void look_over(const Workshop& shop, Stage& stage, Look look) {
  drop_effects(shop, stage);
  if (look == Look::on_the_way && !is_explained(shop, stage)) return;
  drop_refinements(shop, stage);
  add_refinements(shop, stage);
}

}  // namespace estimator::greybox::selection
