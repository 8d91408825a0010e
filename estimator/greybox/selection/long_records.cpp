#include "estimator/greybox/selection/long_records.h"

#include <cmath>

#include "estimator/greybox/representative_segments.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

Workshop for_search(const Workshop& shop) {
  Workshop search = shop;
  if (length_s(shop.evidence) > kLong_s) {
    search.evidence = stretches_of(shop.evidence);
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
    return std::to_string(std::lround(length_s(of.evidence)));
  };
  return "effects were searched for in " + seconds(search) + " of " + seconds(shop) +
         " s; values and errors are those of all samples";
}

}  // namespace estimator::greybox::selection
