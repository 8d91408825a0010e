#include "estimator/greybox/trajectory.h"

#include <cstddef>
#include <memory>

#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/ensemble.h"
#include "plant_sim/ensemble_schedule.h"
#include "plant_sim/plant.h"

namespace estimator::greybox {

using plant_sim::Ensemble;

Trajectory trajectory_of(const plant_sim::ModelFile& model, const Dataset& record,
                         double observer_per_s) {
  const std::unique_ptr<Ensemble> ensemble =
      plant_sim::make_ensemble(model, step_for(model, record.sample_time_s));
  plant_sim::EnsembleSchedule schedule(model, *ensemble);
  schedule.begin(*ensemble);
  Trajectory trajectory;
  trajectory.reading_m.reserve(record.size());
  std::vector<std::size_t> index;
  for (const plant_sim::NamedValue& state :
       plant_sim::make_plant(plant_sim::without_changes(model))->state()) {
    if (const auto found = ensemble->find_state(state.name)) {
      index.push_back(*found);
      trajectory.states.emplace_back(state.name, std::vector<double>{});
      trajectory.states.back().second.reserve(record.size());
    }
  }
  const ObserverCorrection observer(*ensemble, record, observer_per_s);
  std::size_t segment = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    schedule.apply(*ensemble, record.t_s[k], record.sample_time_s);
    if (segment < record.starts.size() && record.starts[segment] == k) {
      ensemble->start(record.y_m[k]);
      ++segment;
    }
    const double reading_m = ensemble->reading_m()[0];
    trajectory.reading_m.push_back(reading_m);
    for (std::size_t s = 0; s < index.size(); ++s) {
      trajectory.states[s].second.push_back(ensemble->state(index[s])[0]);
    }
    Ensemble::Values values;
    values.fill(record.y_m[k] - reading_m);
    observer.apply(*ensemble, k, values);
    values.fill(record.u_V[k]);
    ensemble->advance(values, record.sample_time_s);
  }
  return trajectory;
}

}  // namespace estimator::greybox
