// Records of a velocity servo made here, with an error put in on purpose: truth in closed form.
//
//   y(k+1) = y(k) + Ts (g u(k) + fault(k)),   u held, no lag
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "config/record/record.h"
#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace compare_test {

constexpr double kTs = 0.005;
constexpr double kGain = 0.05;  // m/s per V

inline plant_sim::ModelFile servo() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/velocity_servo.toml");
  *model.value("gain_mps_per_V") = kGain;
  *model.value("time_constant_s") = 0.0;
  return model;
}

/// Time and command in, what is added to the speed out.
using Fault = std::function<double(double t_s, double u_V, double y_m)>;

/// Three sines, whose sum visits many speeds; noise and a 5 um encoder where asked for.
inline config::record::Record servo_record(const Fault& fault, double duration_s = 30.0,
                                           double noise_m = 0.0, double sample_time_s = kTs) {
  config::record::Record r;
  r.name = "made.csv";
  r.sample_time_s = sample_time_s;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  double y_m = 0.3;
  const auto samples = static_cast<std::size_t>(std::lround(duration_s / sample_time_s));
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = sample_time_s * static_cast<double>(k);
    const double u_V = 0.6 * std::sin(2.1 * t_s) + 0.5 * std::sin(5.3 * t_s + 1.0) +
                       0.3 * std::sin(9.7 * t_s + 2.0);
    r.t_s.push_back(t_s);
    r.u_V.push_back(u_V);
    const double read_m = y_m + noise_m * noise(random);
    r.y_m.push_back(noise_m > 0.0 ? 5e-6 * std::round(read_m / 5e-6) : read_m);
    y_m += sample_time_s * (kGain * u_V + fault(t_s, u_V, y_m));
  }
  return r;
}

inline double healthy(double, double, double) { return 0.0; }

}  // namespace compare_test
