// Records of an axis in segments that begin in motion: M v' = g u - d v, u held, solved exactly.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "config/record/record.h"
#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace axis_in_motion {

inline constexpr double kSample_s = 0.005;
inline constexpr double kMass_kg = 4.0;
inline constexpr double kDamping_N_s_per_m = 200.0;
inline constexpr double kForce_N_per_V = 35.0;
inline constexpr int kSegment = 240;  // 1.2 s, of which the first half second settles
inline constexpr int kPause = 40;

inline plant_sim::ModelFile fast_axis() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  *model.value("mass_kg") = kMass_kg;
  *model.value("damping_N_s_per_m") = kDamping_N_s_per_m;
  *model.value("gain_N_per_V") = kForce_N_per_V;
  return model;
}

/// A motion that goes on while nothing is recorded, of `ratio` times the model's force; the sensor
/// shows `reading_m` of a position.
inline estimator::greybox::Dataset segments_in_motion(
    double ratio, const std::function<double(double)>& reading_m = [](double y_m) { return y_m; }) {
  config::record::Record record;
  record.name = "made.csv";
  record.sample_time_s = kSample_s;
  const double kept = std::exp(-kDamping_N_s_per_m / kMass_kg * kSample_s);
  const double lasts_s = kMass_kg / kDamping_N_s_per_m;
  double y_m = 0.3;
  double v_mps = 0.0;
  for (int k = 0; k < 20 * (kSegment + kPause); ++k) {
    const double t_s = kSample_s * k;
    const double u_V = 2.0 * std::sin(2.1 * t_s) + 1.4 * std::sin(5.3 * t_s + 1.0);
    if (k % (kSegment + kPause) >= kPause) {
      if (k % (kSegment + kPause) == kPause && k > kPause) {
        record.gaps.push_back(record.t_s.size());
      }
      record.t_s.push_back(t_s);
      record.u_V.push_back(u_V);
      record.y_m.push_back(reading_m(y_m));
    }
    const double end_mps = ratio * kForce_N_per_V * u_V / kDamping_N_s_per_m;
    y_m += end_mps * kSample_s + (v_mps - end_mps) * lasts_s * (1.0 - kept);
    v_mps = end_mps + (v_mps - end_mps) * kept;
  }
  return estimator::greybox::dataset_of(record);
}

}  // namespace axis_in_motion
