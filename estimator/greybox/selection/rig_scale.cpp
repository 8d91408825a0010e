#include "estimator/greybox/selection/rig_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plant_sim/hydraulics.h"

namespace estimator::greybox::selection {

RigScale rig_scale(plant_sim::ModelFile model, const FitDataset& data) {
  RigScale scale;
  double squares_m2 = 0.0;
  double squares_m2ps2 = 0.0;
  double squares_V2 = 0.0;
  double sum_V = 0.0;
  double most_V = 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = -least_m;
  double samples = 0.0;
  for (const Dataset& record : data.records) {
    double mean_m = 0.0;
    for (const double y_m : record.y_m) {
      mean_m += y_m / static_cast<double>(record.size());
      least_m = std::min(least_m, y_m);
      most_m = std::max(most_m, y_m);
    }
    for (std::size_t k = 1; k < record.size(); ++k) {
      const double speed_mps = (record.y_m[k] - record.y_m[k - 1]) / record.sample_time_s;
      squares_m2 += (record.y_m[k] - mean_m) * (record.y_m[k] - mean_m);
      squares_m2ps2 += speed_mps * speed_mps;
      squares_V2 += record.u_V[k] * record.u_V[k];
      sum_V += record.u_V[k];
      most_V = std::max(most_V, std::abs(record.u_V[k]));
      samples += 1.0;
    }
  }
  scale.length_m = std::sqrt(squares_m2 / samples);
  scale.speed_mps = std::sqrt(squares_m2ps2 / samples);
  scale.command_V = std::sqrt(squares_V2 / samples);
  const double mean_V = sum_V / samples;
  scale.command_sd_V = std::sqrt(std::max(0.0, squares_V2 / samples - mean_V * mean_V));
  scale.most_command_V = most_V;
  scale.centre_m = 0.5 * (least_m + most_m);
  if (const auto oil = plant_sim::hydraulics_of(model)) {
    scale.area_m2 = oil->area_m2;
    scale.pressure_Pa = oil->supply_pressure_Pa;
    scale.force_N = oil->area_m2 * oil->supply_pressure_Pa;
  } else if (const double* const gain = model.value("gain_N_per_V")) {
    scale.force_N = *gain * most_V;
  }
  return scale;
}

}  // namespace estimator::greybox::selection
