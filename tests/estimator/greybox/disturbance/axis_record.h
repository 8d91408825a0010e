// A force-driven axis under a made-up command: a plant whose linearisation is known in closed form.
#pragma once

#include <cmath>
#include <string>

#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace disturbance_test {

inline constexpr double kTs_s = 0.005;

inline plant_sim::ModelFile axis() {
  return plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                               "/config/models/force_driven_axis.toml");
}

inline estimator::greybox::Dataset axis_record(std::size_t samples = 800) {
  estimator::greybox::Dataset record;
  record.name = "made";
  record.sample_time_s = kTs_s;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = kTs_s * static_cast<double>(k);
    record.t_s.push_back(t_s);
    record.u_V.push_back(1.5 * std::sin(4.0 * t_s) + 0.3 * std::cos(23.0 * t_s));
    record.y_m.push_back(1e-3 * std::sin(3.0 * t_s));
    record.valid.push_back(1);
  }
  record.starts = {0};
  return record;
}

}  // namespace disturbance_test
