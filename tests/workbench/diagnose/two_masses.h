// Records of an axis with a second mass behind a spring, from the matrix exponential of its four
// linear states: no code of the product's.
//
//   m1 x'' = g u - d x' + k (q - x) + c (q' - x') + F1,   m2 q'' = -k (q - x) - c (q' - x') + F2
//
// F1, F2  disturbance from outside on either mass, a first-order Markov process
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <random>

#include "config/record/record.h"

namespace two_masses {

struct Rig {
  double mass_kg = 30.0;  ///< both masses together
  double damping_N_s_per_m = 120.0;
  double gain_N_per_V = 40.0;
  double mass_ratio = 0.3;         ///< second mass over both; 0: one rigid mass
  double resonance_Hz = 34.0;      ///< frequency of the free pair
  double damping_ratio = 0.03;     ///< damping ratio of that resonance
  bool at_load = false;            ///< sensor on the second mass
  double stiffness_N_per_m = 0.0;  ///< spring between the driven mass and the ground
  double sample_rate_Hz = 1000.0;
  double duration_s = 12.0;
  double noise_m = 2e-6;
  double step_m = 1e-3;  ///< step of the reference, up and down at 0.7 Hz
  double kp_V_per_m = 300.0;
  double kd_V_s_per_m = 12.0;
  int delay_samples = 0;
  double driven_disturbance_N = 0.0;  ///< standard deviation of F1
  double second_disturbance_N = 0.0;  ///< that of F2
  double disturbance_corner_Hz = 2.0;
  unsigned seed = 1;
};

/// exp(A) by scaling and squaring of its series.
inline Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
  constexpr int kHalvings = 10;
  constexpr int kTerms = 16;
  const Eigen::MatrixXd small = A / std::pow(2.0, kHalvings);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  Eigen::MatrixXd term = sum;
  for (int i = 1; i <= kTerms; ++i) {
    term = (term * small / i).eval();
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = (sum * sum).eval();
  return sum;
}

/// States x, x', q, q', and the held forces on the driven and on the second mass.
inline Eigen::MatrixXd transition(const Rig& rig) {
  const double w = 2.0 * std::numbers::pi * rig.resonance_Hz;
  const double ratio = std::max(rig.mass_ratio, 1e-6);
  const double m1 = (1.0 - ratio) * rig.mass_kg;
  const double m2 = ratio * rig.mass_kg;
  const double k = m1 * m2 / (m1 + m2) * w * w;
  const double c = m1 * m2 / (m1 + m2) * 2.0 * rig.damping_ratio * w;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6, 6);
  A(0, 1) = 1.0;
  A.row(1) << -(k + rig.stiffness_N_per_m) / m1, -(c + rig.damping_N_s_per_m) / m1, k / m1, c / m1,
      1.0 / m1, 0.0;
  A(2, 3) = 1.0;
  A.row(3) << k / m2, c / m2, -k / m2, -c / m2, 0.0, 1.0 / m2;
  return exponential(A / rig.sample_rate_Hz);
}

/// Simulates closed loop on a multisine of 20 lines up to 2 Hz with steps, which alone excite a
/// resonance of tens of hertz; the position is about `kMiddle_m`.
inline config::record::Record record(const Rig& rig) {
  constexpr double kMiddle_m = 0.2;
  constexpr double kEncoder_m = 1e-6;
  constexpr int kLines = 20;
  std::mt19937 random(rig.seed);
  std::normal_distribution<double> noise_m(0.0, rig.noise_m);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  double phases[kLines];
  for (double& one : phases) one = phase(random);
  const double sample_s = 1.0 / rig.sample_rate_Hz;
  const auto reference_m = [&](double t_s) {
    double sum = std::fmod(0.7 * t_s, 1.0) < 0.5 ? rig.step_m : 0.0;
    for (int i = 1; i <= kLines; ++i) {
      sum += 0.02 / i * std::sin(2.0 * std::numbers::pi * 0.1 * i * t_s + phases[i - 1]);
    }
    return sum;
  };
  const Eigen::MatrixXd step = transition(rig);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
  x[0] = x[2] = reference_m(0.0);
  std::vector<double> past_V(static_cast<std::size_t>(rig.delay_samples) + 1, 0.0);
  config::record::Record out;
  double last_m = x[0];
  double speed_mps = 0.0;
  std::mt19937 outside(rig.seed + 1000);
  std::normal_distribution<double> normal(0.0, 1.0);
  double disturbance = normal(outside);  // its standard deviation is 1
  const double keep =
      std::exp(-2.0 * std::numbers::pi * rig.disturbance_corner_Hz / rig.sample_rate_Hz);
  const auto samples = std::lround(rig.duration_s * rig.sample_rate_Hz);
  for (long n = 0; n < samples; ++n) {
    const double t_s = static_cast<double>(n) * sample_s;
    const double y_m =
        kEncoder_m * std::round((x[rig.at_load ? 2 : 0] + noise_m(random)) / kEncoder_m);
    speed_mps += 0.1 * ((y_m - last_m) * rig.sample_rate_Hz - speed_mps);
    last_m = y_m;
    const double u_V = rig.kp_V_per_m * (reference_m(t_s) - y_m) - rig.kd_V_s_per_m * speed_mps;
    out.t_s.push_back(t_s);
    out.u_V.push_back(u_V);
    out.y_m.push_back(kMiddle_m + y_m);
    past_V.insert(past_V.begin(), u_V);
    past_V.pop_back();
    x[4] = rig.gain_N_per_V * past_V.back() + rig.driven_disturbance_N * disturbance;
    x[5] = rig.second_disturbance_N * disturbance;
    disturbance = keep * disturbance + std::sqrt(1.0 - keep * keep) * normal(outside);
    x = (step * x).eval();
  }
  return out;
}

}  // namespace two_masses
