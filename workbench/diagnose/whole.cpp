#include "workbench/diagnose/whole.h"

#include <cmath>

#include "workbench/diagnose/parallel.h"
#include "workbench/diagnose/selection.h"
#include "workbench/matching/stretches.h"

namespace workbench::diagnose {

Workshop for_search(const Workshop& shop) {
  Workshop search = shop;
  if (matching::length_s(shop.evidence) > matching::kLong_s) {
    search.evidence = matching::stretches_of(shop.evidence);
  }
  return search;
}

bool searches_in_part(const Workshop& search, const Workshop& shop) {
  return search.evidence.size() < shop.evidence.size();
}

void carry_to_whole(const Workshop& shop, Ladder& ladder) {
  ladder.nominal_rms_m = nominal_rms_m(shop);
  in_parallel(ladder.way.size(), shop.threads, [&](std::size_t i) {
    Stage& stage = ladder.way[i];
    stage.fitted =
        refit(shop, select(stage.fitted, [](const auto&) { return true; }), shop.evidence.fits);
    stage.fitted.jacobian.resize(0, 0);  // large, and of no use any more
  });
  ladder.final = ladder.way.back();
  ladder.interrupted = ladder.interrupted || shop.cancelled();
}

std::string note_of_search(const Workshop& search, const Workshop& shop) {
  const auto seconds = [](const Workshop& of) {
    return std::to_string(std::lround(matching::length_s(of.evidence)));
  };
  return "effects were searched for in " + seconds(search) + " of " + seconds(shop) +
         " s; values and errors are those of all samples";
}

}  // namespace workbench::diagnose
