#include "workbench/diagnose/look_over.h"

#include <algorithm>
#include <array>
#include <set>

#include "workbench/diagnose/ladder.h"
#include "workbench/diagnose/parallel.h"
#include "workbench/diagnose/selection.h"

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
              shop.evidence.fits);
    if (!costs_little(shop, without, stage.fitted)) {
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
      if (costs_little(shop, without, stage.fitted)) stage.fitted = std::move(without);
    }
  }
}

/// The records in two halves, each begun anew, fitted to one and scored on the other; records that
/// were kept for scoring are one of the halves.
struct Halves {
  matching::Evidence forth;
  matching::Evidence back;
};

Halves halves_of(const matching::Evidence& evidence) {
  std::vector<matching::Measured> first;
  std::vector<matching::Measured> second;
  if (evidence.scores_apart()) {
    const auto kept =
        evidence.records.begin() + static_cast<std::ptrdiff_t>(evidence.fitted_records);
    first.assign(evidence.records.begin(), kept);
    second.assign(kept, evidence.records.end());
    return {matching::evidence(first, second), matching::evidence(second, first)};
  }
  for (const matching::Measured& record : evidence.records) {
    first.push_back(matching::part(record, 0, record.size() / 2));
    second.push_back(matching::part(record, record.size() / 2, record.size()));
  }
  return {matching::evidence(first, second), matching::evidence(second, first)};
}

/// Whether both halves do better with `more` than with `plain`. Where noise is all that is left of
/// the error the observer helps; otherwise the models have to prove themselves without it.
bool supported(const Workshop& shop, bool explained, const Selection& plain,
               const Selection& more) {
  const Halves halves = halves_of(shop.evidence);
  matching::FitOptions options;
  options.tolerance = 1e-5;
  options.final_jacobian = false;
  options.cancel = shop.cancel;
  if (!explained) options.observer_per_s = 0.0;
  std::array<double, 4> score_rms_m{};
  in_parallel(score_rms_m.size(), shop.threads, [&](std::size_t i) {
    const Selection& selection = i % 2 == 0 ? plain : more;
    const matching::Evidence& evidence = i < 2 ? halves.forth : halves.back;
    score_rms_m[i] = matching::fit(shop.model, evidence, evidence.fits, selection.searched,
                                   selection.start, options)
                         .score_rms_m;
  });
  const double enough = 1.0 - worthwhile_at(shop, score_rms_m[0]);
  return score_rms_m[1] < enough * score_rms_m[0] && score_rms_m[3] < enough * score_rms_m[2];
}

bool is_explained(const Workshop& shop, const Stage& stage) {
  return stage.fitted.score_rms_m <= kUnexplained * shop.evidence.noise_floor_m;
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
      stage.fitted = refit(shop, more, shop.evidence.fits);
    }
  }
}

}  // namespace

void look_over(const Workshop& shop, Stage& stage) {
  drop_effects(shop, stage);
  drop_refinements(shop, stage);
  add_refinements(shop, stage);
}

void keep_supported(const Workshop& shop, Stage& stage) {
  for (std::size_t i = stage.added.size(); i-- > 0 && stage.added.size() > 1;) {
    const std::string effect = stage.added[i];
    const Selection more = select(stage.fitted, [](const auto&) { return true; });
    const Selection plain =
        select(stage.fitted, [&](const auto& p) { return !belongs(p, effect); });
    if (supported(shop, is_explained(shop, stage), plain, more) || shop.cancelled()) continue;
    stage.added.erase(stage.added.begin() + static_cast<std::ptrdiff_t>(i));
    stage.fitted = refit(shop, plain, shop.evidence.fits);
  }
}

}  // namespace workbench::diagnose
