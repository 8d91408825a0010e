#include "workbench/fit/fit_report.h"

namespace workbench::fit {

FitReport run(const PreparedFit& prepared) {
  FitReport outcome;
  outcome.prepared = &prepared;
  outcome.noise_floor_m = prepared.noise_floor_m;
  outcome.output = prepared.output;
  outcome.estimation = greybox::estimate(prepared.problem, prepared.options);
  outcome.runtime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - prepared.begin).count();
  return outcome;
}

}  // namespace workbench::fit
