#include "workbench/compare/disturbance_check.h"

#include <cmath>

#include "config/schema/error.h"
#include "estimator/greybox/observer_simulation.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;

DisturbanceCheck check_disturbance(const plant_sim::ModelFile& model,
                                   const validation::Comparison& comparison, unsigned threads,
                                   const std::function<bool()>& cancel) {
  DisturbanceCheck check;
  if (!std::isfinite(comparison.rms_m) || !(comparison.floor_ratio() > validation::kAtFloor) ||
      comparison.observer_per_s != greybox::kObserver_per_s ||
      comparison.systematic.cause != validation::ErrorCause::neither) {
    return check;
  }
  greybox::selection::DiagnosisOptions options;
  options.threads = threads;
  options.cancel = cancel;
  try {
    check.found = greybox::selection::remaining_disturbance(model, comparison.record, options);
    check.asked = !(cancel && cancel());
  } catch (const config::schema::DataError&) {
    // too short to tell, yet long enough to be compared
  }
  return check;
}

}  // namespace workbench::compare
