#include "estimator/greybox/selection/selection_path.h"

#include <algorithm>

#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// After so many iterations, only what is within that factor of the best goes on to the end.
constexpr int kFirstIterations = 8;
constexpr double kFar = 1.5;
/// What takes away that much of the held-out error needs no further support.
constexpr double kPlainToSee = 0.5;

/// `before` with one effect more, which starts as it is in the final model.
Selection taking(const Stage& before, const Stage& final, const std::string& effect) {
  Selection selection = select(before.fitted, [](const auto&) { return true; });
  append(selection, select(final.fitted, [&](const auto& p) { return belongs(p, effect); }));
  return selection;
}

Stage taken(const Stage& before, const std::string& effect, Fitted fitted) {
  Stage next{before.added, std::move(fitted)};
  next.added.push_back(effect);
  return next;
}

/// Of the effects the one that does most at once.
Stage best_of(const Workshop& shop, const Stage& before, const Stage& final,
              const std::vector<std::string>& effects) {
  FitOptions begin;
  begin.max_iterations = kFirstIterations;
  begin.final_jacobian = false;
  begin.cancel = shop.cancel;
  std::vector<Selection> selections;
  selections.reserve(effects.size());
  for (const std::string& effect : effects) selections.push_back(taking(before, final, effect));
  std::vector<Fitted> fits(effects.size());
  in_parallel(effects.size(), shop.threads, [&](std::size_t i) {
    fits[i] = fit(shop.model, shop.evidence, shop.evidence.fits, selections[i].searched,
                  selections[i].start, begin);
  });
  const auto lower = [](const auto& a, const auto& b) { return a.score_rms_m < b.score_rms_m; };
  const double least_m = std::min_element(fits.begin(), fits.end(), lower)->score_rms_m;
  const auto far = [&](const auto& fit) { return fit.score_rms_m > kFar * least_m; };
  const auto near = static_cast<unsigned>(fits.size()) -
                    static_cast<unsigned>(std::count_if(fits.begin(), fits.end(), far));
  const unsigned side_by_side = std::clamp(near, 1U, shop.threads);
  in_parallel(effects.size(), side_by_side, [&](std::size_t i) {
    if (far(fits[i])) return;
    fits[i] = refit(shop, {selections[i].searched, fits[i].x}, shop.evidence.fits,
                    shop.threads / side_by_side);
  });
  const auto best = std::min_element(fits.begin(), fits.end(), lower);
  return taken(before, effects[static_cast<std::size_t>(best - fits.begin())], std::move(*best));
}

}  // namespace

std::vector<Stage> way_to(const Workshop& shop, const Stage& first, const Stage& final) {
  std::vector<Stage> way{first};
  std::vector<std::string> remaining = final.added;
  while (remaining.size() > 1 && !shop.cancelled()) {
    way.push_back(best_of(shop, way.back(), final, remaining));
    std::erase(remaining, way.back().added.back());
  }
  if (remaining.empty()) return way;
  Stage last = final;
  last.added = way.back().added;
  last.added.insert(last.added.end(), remaining.begin(), remaining.end());
  way.push_back(std::move(last));
  return way;
}

std::vector<Stage> supported_way(const Workshop& shop, const std::vector<Stage>& way) {
  std::vector<Stage> kept{way.front()};
  const auto all = [](const Stage& stage) {
    return select(stage.fitted, [](const auto&) { return true; });
  };
  for (std::size_t i = 1; i < way.size() && !shop.cancelled(); ++i) {
    const std::string& effect = way[i].added.back();
    Stage more = taken(
        kept.back(), effect,
        refit(shop, taking(kept.back(), way.back(), effect), shop.evidence.fits, shop.threads));
    const bool plain_to_see =
        more.fitted.score_rms_m < kPlainToSee * kept.back().fitted.score_rms_m;
    if (plain_to_see || supported(shop, false, all(kept.back()), all(more))) {
      kept.push_back(std::move(more));
    }
  }
  return kept;
}

}  // namespace estimator::greybox::selection
