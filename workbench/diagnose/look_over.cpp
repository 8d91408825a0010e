#include "workbench/diagnose/look_over.h"

#include <algorithm>
#include <set>

#include "workbench/diagnose/ladder.h"
#include "workbench/diagnose/selection.h"
#include "workbench/diagnose/support.h"

namespace workbench::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using matching::Fitted;
using matching::SearchParameter;

bool costs_little(const Workshop& shop, const Fitted& without, const Fitted& with) {
  return without.score_rms_m < (1.0 + worthwhile_at(shop, with.score_rms_m)) * with.score_rms_m;
}

void drop_effects(const Workshop& shop, Stage& stage) {
  for (std::size_t i = 0; stage.added.size() > 1 && i < stage.added.size() && !shop.cancelled();) {
    const std::string effect = stage.added[i];
    Fitted without =
        refit(shop, select(stage.fitted, [&](const auto& p) { return !belongs(p, effect); }),
              shop.evidence.fits, shop.threads);
    if (!costs_little(shop, without, stage.fitted)) {
      ++i;
      continue;
    }
    stage.fitted = std::move(without);
    stage.added.erase(stage.added.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
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

void drop_refinements(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    for (const int refinement : refinements_of(stage.fitted, effect)) {
      if (shop.cancelled()) return;
      const Selection plain = without_refinement(stage.fitted, effect, refinement);
      Fitted without = refit(shop, plain, shop.evidence.fits, shop.threads);
      const bool earned =
          !costs_little(shop, without, stage.fitted) &&
          (is_explained(shop, stage) ||
           supported(shop, false, plain, select(stage.fitted, [](const auto&) { return true; })));
      if (!earned) stage.fitted = std::move(without);
    }
  }
}

void add_refinements(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    const auto info = std::find_if(shop.absent.begin(), shop.absent.end(),
                                   [&](const auto& absent) { return absent.name == effect; });
    if (info == shop.absent.end()) continue;
    std::set<int> missing;
    const std::vector<SearchParameter> all =
        matching::effect_parameters(*info, matching::kEveryRefinement);
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

void drop_hindrances(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    for (const int refinement : refinements_of(stage.fitted, effect)) {
      if (shop.cancelled()) return;
      Fitted without = refit(shop, without_refinement(stage.fitted, effect, refinement),
                             shop.evidence.fits, shop.threads);
      if (without.score_rms_m < stage.fitted.score_rms_m) stage.fitted = std::move(without);
    }
  }
}

void look_over(const Workshop& shop, Stage& stage, Look look) {
  drop_effects(shop, stage);
  if (look == Look::on_the_way && !is_explained(shop, stage)) return;
  drop_refinements(shop, stage);
  add_refinements(shop, stage);
}

}  // namespace workbench::diagnose
