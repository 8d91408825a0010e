#include "tests/truth/axis.h"

#include <cmath>

namespace truth {
namespace {

constexpr double kMotor = 0.4;  ///< its share of the mass when the shaft is elastic
constexpr double kShaftDamping = 0.02;

}  // namespace

AxisPlant printed_axis(bool rotary) { return rotary ? AxisPlant{0.05, 0.3, 0.8} : AxisPlant{}; }

Axis::Axis(const AxisPlant& plant_, const Hidden& hidden_, const LeftOut& left_out_)
    : Machine(hidden_, left_out_), plant(plant_), mass_kg_(plant.mass_kg + hidden.slaves_kg) {}

State Axis::rest(double y_m) const { return {y_m, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

State Axis::rate(const State& x, double u_V, double t_s) const {
  const double v_mps = x[1];
  const double z_m = x[6];
  State r{};
  double load_N = resisting_N(x[0], v_mps, t_s);
  if (hidden.coulomb_N > 0.0) {
    r[6] = bristle_rate_mps(z_m, v_mps);
    load_N += friction_N(z_m, v_mps, r[6]);
  }
  if (hidden.lag_s > 0.0) r[4] = (u_V - x[4]) / hidden.lag_s;
  const double drive_N = plant.gain_N_per_V * (hidden.lag_s > 0.0 ? x[4] : u_V);
  r[0] = v_mps;
  if (left_out.kind != LeftOut::Kind::elastic_shaft) {
    r[1] = (drive_N - plant.damping_N_s_per_m * v_mps - load_N) / mass_kg_;
    return r;
  }
  const double twist_mps = x[3] - v_mps;
  const double reduced_kg = kMotor * (1.0 - kMotor) * mass_kg_;
  const double shaft_N = left_out.size * x[2] +
                         2.0 * kShaftDamping * std::sqrt(left_out.size * reduced_kg) * twist_mps;
  r[1] = (shaft_N - load_N) / ((1.0 - kMotor) * mass_kg_);
  r[2] = twist_mps;
  r[3] = (drive_N - plant.damping_N_s_per_m * x[3] - shaft_N) / (kMotor * mass_kg_);
  return r;
}

}  // namespace truth
