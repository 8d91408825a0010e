// A model's motion for a record's command, sample by sample, with its states.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

struct Trajectory {
  std::vector<double> reading_m;  ///< modelled position as the sensor shows it, before noise
  /// Integration states by name, SI ("v_mps", "in_Pa", ...), as they are when the position is read.
  std::vector<std::pair<std::string, std::vector<double>>> states;
};

/// Each segment starts where the record's position is. Observer gain 0 is the free run; the numbers
/// are those of ObserverSimulation. Throws config::schema::ConfigError like make_plant().
[[nodiscard]] Trajectory trajectory_of(const plant_sim::ModelFile& model, const Dataset& record,
                                       double observer_per_s = 0.0);

}  // namespace estimator::greybox
