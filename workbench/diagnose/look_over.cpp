#include "workbench/diagnose/look_over.h"

#include <algorithm>
#include <optional>
#include <set>

#include "workbench/diagnose/ladder.h"

namespace workbench::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using matching::Fitted;
using matching::SearchParameter;

bool belongs(const SearchParameter& parameter, const std::string& effect) {
  return parameter.name.rfind(effect + ".", 0) == 0;
}

struct Selection {
  std::vector<SearchParameter> searched;
  VectorXd start;
};

/// The stage's parameters for which keep(parameter) holds.
template <class Keep>
Selection select(const Fitted& fitted, const Keep& keep) {
  Selection result;
  std::vector<double> values;
  for (std::size_t i = 0; i < fitted.searched.size(); ++i) {
    if (!keep(fitted.searched[i])) continue;
    result.searched.push_back(fitted.searched[i]);
    values.push_back(fitted.x[static_cast<Index>(i)]);
  }
  result.start = Eigen::Map<VectorXd>(values.data(), static_cast<Index>(values.size()));
  return result;
}

Fitted refit(const Workshop& shop, const Selection& selection, const VectorXd& weights) {
  matching::FitOptions options;
  options.tolerance = 1e-5;
  options.cancel = shop.cancel;
  return matching::fit(shop.model, shop.evidence, weights, selection.searched, selection.start,
                       options);
}

bool costs_little(const Fitted& without, const Fitted& with) {
  return without.score_rms_m < (1.0 + kWorthwhile) * with.score_rms_m;
}

void drop_effects(const Workshop& shop, Stage& stage) {
  for (std::size_t i = 0; stage.added.size() > 1 && i < stage.added.size() && !shop.cancelled();) {
    const std::string effect = stage.added[i];
    Fitted without =
        refit(shop, select(stage.fitted, [&](const auto& p) { return !belongs(p, effect); }),
              shop.evidence.fits);
    if (!costs_little(without, stage.fitted)) {
      ++i;
      continue;
    }
    stage.fitted = std::move(without);
    stage.added.erase(stage.added.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
}

void drop_refinements(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    std::set<int, std::greater<>> refinements;
    for (const SearchParameter& p : stage.fitted.searched) {
      if (belongs(p, effect) && p.refinement > 0) refinements.insert(p.refinement);
    }
    for (const int refinement : refinements) {
      if (shop.cancelled()) return;
      Fitted without = refit(
          shop,
          select(stage.fitted,
                 [&](const auto& p) { return !belongs(p, effect) || p.refinement != refinement; }),
          shop.evidence.fits);
      if (costs_little(without, stage.fitted)) stage.fitted = std::move(without);
    }
  }
}

/// The error of each half of what counts under a fit to the other half.
std::optional<std::pair<double, double>> crossed(const Workshop& shop, const Selection& selection) {
  const VectorXd& counts = shop.evidence.counts;
  VectorXd first = counts;
  VectorXd second = counts;
  double before = 0.0;
  for (Index i = 0; i < counts.size(); ++i) {
    (2.0 * before < counts.sum() ? second : first)[i] = 0.0;
    before += counts[i];
  }
  if (shop.cancelled()) return std::nullopt;
  return std::pair(matching::rms(refit(shop, selection, first).residual_m, second),
                   matching::rms(refit(shop, selection, second).residual_m, first));
}

void add_refinements(const Workshop& shop, Stage& stage) {
  for (const std::string& effect : stage.added) {
    const plant_sim::EffectInfo* info = plant_sim::find_effect(effect);
    if (info == nullptr) continue;
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
      const auto without = crossed(shop, plain);
      const auto with = crossed(shop, more);
      if (!without || !with) return;
      const bool first = with->first < (1.0 - kWorthwhile) * without->first;
      const bool second = with->second < (1.0 - kWorthwhile) * without->second;
      if (first && second) stage.fitted = refit(shop, more, shop.evidence.fits);
    }
  }
}

}  // namespace

void look_over(const Workshop& shop, Stage& stage) {
  drop_effects(shop, stage);
  drop_refinements(shop, stage);
  add_refinements(shop, stage);
}

}  // namespace workbench::diagnose
