#include "estimator/greybox/selection/cross_validation.h"

#include <array>

#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// The records in two halves, each begun anew, fitted to one and scored on the other; records that
/// were kept for scoring are one of the halves.
struct Halves {
  Evidence forth;
  Evidence back;
};

Halves halves_of(const Evidence& evidence) {
  std::vector<Measured> first;
  std::vector<Measured> second;
  if (evidence.scores_apart()) {
    const auto kept =
        evidence.records.begin() + static_cast<std::ptrdiff_t>(evidence.fitted_records);
    first.assign(evidence.records.begin(), kept);
    second.assign(kept, evidence.records.end());
    return {greybox::evidence(first, second), greybox::evidence(second, first)};
  }
  for (const Measured& record : evidence.records) {
    first.push_back(part(record, 0, record.size() / 2));
    second.push_back(part(record, record.size() / 2, record.size()));
  }
  return {greybox::evidence(first, second), greybox::evidence(second, first)};
}

}  // namespace

bool supported(const Workshop& shop, bool explained, const Selection& plain,
               const Selection& more) {
  const Halves halves = halves_of(shop.evidence);
  FitOptions options;
  options.tolerance = 1e-4;
  options.max_iterations = 15;
  options.final_jacobian = false;
  options.cancel = shop.cancel;
  if (!explained) {
    // the free run: its minimum is narrow, and what is not reached decides wrongly
    options.observer_per_s = 0.0;
    options.tolerance = 1e-5;
    options.max_iterations = FitOptions{}.max_iterations;
  }
  std::array<double, 4> score_rms_m{};
  in_parallel(score_rms_m.size(), shop.threads, [&](std::size_t i) {
    const Selection& selection = i % 2 == 0 ? plain : more;
    const Evidence& evidence = i < 2 ? halves.forth : halves.back;
    score_rms_m[i] =
        fit(shop.model, evidence, evidence.fits, selection.searched, selection.start, options)
            .score_rms_m;
  });
  const double enough = 1.0 - worthwhile_at(shop, score_rms_m[0]);
  return score_rms_m[1] < enough * score_rms_m[0] && score_rms_m[3] < enough * score_rms_m[2];
}

bool is_explained(const Workshop& shop, const Stage& stage) {
  return stage.fitted.score_rms_m <= kUnexplained * shop.evidence.noise_floor_m;
}

}  // namespace estimator::greybox::selection
