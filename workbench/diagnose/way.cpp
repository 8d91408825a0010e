#include "workbench/diagnose/way.h"

#include <algorithm>

#include "workbench/diagnose/parallel.h"
#include "workbench/diagnose/selection.h"
#include "workbench/diagnose/support.h"

namespace workbench::diagnose {
namespace {

/// What takes away that much of the held-out error needs no further support.
constexpr double kPlainToSee = 0.5;

/// `before` with one effect more, which starts as it is in the final model.
Stage taking(const Workshop& shop, const Stage& before, const Stage& final,
             const std::string& effect, unsigned threads) {
  Selection selection = select(before.fitted, [](const auto&) { return true; });
  append(selection, select(final.fitted, [&](const auto& p) { return belongs(p, effect); }));
  Stage next = before;
  next.added.push_back(effect);
  next.fitted = refit(shop, selection, shop.evidence.fits, threads);
  return next;
}

}  // namespace

std::vector<Stage> way_to(const Workshop& shop, const Stage& first, const Stage& final) {
  std::vector<Stage> way{first};
  std::vector<std::string> remaining = final.added;
  while (remaining.size() > 1 && !shop.cancelled()) {
    std::vector<Stage> next(remaining.size());
    in_parallel(remaining.size(), shop.threads,
                [&](std::size_t i) { next[i] = taking(shop, way.back(), final, remaining[i], 1); });
    const auto best = std::min_element(next.begin(), next.end(), [](const auto& a, const auto& b) {
      return a.fitted.score_rms_m < b.fitted.score_rms_m;
    });
    std::erase(remaining, best->added.back());
    way.push_back(std::move(*best));
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
    Stage more = taking(shop, kept.back(), way.back(), way[i].added.back(), shop.threads);
    const bool plain_to_see =
        more.fitted.score_rms_m < kPlainToSee * kept.back().fitted.score_rms_m;
    if (plain_to_see || supported(shop, false, all(kept.back()), all(more))) {
      kept.push_back(std::move(more));
    }
  }
  return kept;
}

}  // namespace workbench::diagnose
