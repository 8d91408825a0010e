#include "estimator/greybox/validation/k_step.h"

#include <cmath>

#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/ensemble.h"
#include "plant_sim/ensemble_schedule.h"

namespace estimator::greybox::validation {
namespace {

using plant_sim::Ensemble;

/// One of the simulations side by side: set to the measurement at samples offset, offset + k, ...
struct Lane {
  std::size_t horizon = 0;  ///< index of the result
  std::size_t samples = 1;
  std::size_t offset = 0;
};

/// One lane for k = 1, three for 10, four for 100.
std::vector<Lane> lanes() {
  std::vector<Lane> all{{0, 1, 0}};
  for (std::size_t i = 0; i < 3; ++i) all.push_back({1, 10, 3 * i});
  for (std::size_t i = 0; i < 4; ++i) all.push_back({2, 100, 25 * i});
  return all;
}

}  // namespace

std::vector<KStep> k_step_errors(const plant_sim::ModelFile& model, const Dataset& record) {
  std::vector<KStep> result{{1}, {10}, {100}};
  const std::vector<Lane> all = lanes();
  static_assert(Ensemble::kLanes == 8);
  const auto ensemble = plant_sim::make_ensemble(model, step_for(model, record.sample_time_s));
  plant_sim::EnsembleSchedule schedule(model, *ensemble);
  schedule.begin(*ensemble);
  const ObserverCorrection start(*ensemble, record, kObserver_per_s);
  std::vector<double> squares(result.size(), 0.0);
  for (const SampleRange& span : segments(record)) {
    // at rest under the parameters of that time
    schedule.apply(*ensemble, record.t_s[span.begin], record.sample_time_s);
    ensemble->start(record.y_m[span.begin]);
    std::vector<std::size_t> synchronised(all.size(), span.begin);
    for (std::size_t k = span.begin; k < span.end; ++k) {
      schedule.apply(*ensemble, record.t_s[k], record.sample_time_s);
      const Ensemble::Values reading_m = ensemble->reading_m();
      const bool starts = start.finds_speed(k);
      Ensemble::Values by_m{};
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Lane& lane = all[i];
        if (starts) by_m[i] = record.y_m[k] - reading_m[i];
        if (starts || (k - span.begin) % lane.samples != lane.offset % lane.samples) continue;
        const double error_m = record.y_m[k] - reading_m[i];
        if (k - synchronised[i] == lane.samples && record.valid[synchronised[i]] != 0) {
          squares[lane.horizon] += error_m * error_m;
          ++result[lane.horizon].count;
        }
        by_m[i] = error_m;
        synchronised[i] = k;
      }
      if (starts) {
        start.apply(*ensemble, k, by_m);
      } else {
        ensemble->shift(by_m);
      }
      Ensemble::Values u_V;
      u_V.fill(record.u_V[k]);
      ensemble->advance(u_V, record.sample_time_s);
    }
  }
  for (std::size_t h = 0; h < result.size(); ++h) {
    if (result[h].count == 0) continue;
    result[h].rms_m = std::sqrt(squares[h] / static_cast<double>(result[h].count));
  }
  return result;
}

}  // namespace estimator::greybox::validation
