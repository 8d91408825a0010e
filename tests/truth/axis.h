// An electric axis: a linear motor, or a motor with a fast current loop that turns a joint.
//
//   M v' = g u - d v - F(y, v)          F: load and friction of machine.h, |u| limited
//
// With a lag of the drive z in the place of u: lag z' = u - z, z = 0 at rest.
// Rotary: the same equation in rad, kg m^2 and N m, under the names of metre, kg and N.
// With the left-out elastic shaft of stiffness s the motor, 40 % of M, drives the load through it:
//
//   0.4 M v1' = g u - d v1 - S      0.6 M v' = S - F      S = s e + 2 zeta w 0.24 M e',  e' = v1 -
//   v
//
// with w^2 = s/(0.24 M), zeta = 0.02; the sensor is on the load.
// Source: Janot, Gautier, Brunot, Data set and reference models of EMPS (2019).
#pragma once

#include "tests/truth/machine.h"

namespace truth {

struct AxisPlant {
  double mass_kg = 100.0;
  double damping_N_s_per_m = 200.0;
  double gain_N_per_V = 35.0;
};

/// The axis by its drawing: a linear motor, or a joint (kg m^2, N m s/rad, N m/V).
AxisPlant printed_axis(bool rotary);

/// State: y, v, twist e, motor speed, what the drive makes of the command, one without use, bristle
/// deflection.
class Axis : public Machine {
 public:
  Axis(const AxisPlant& plant, const Hidden& hidden, const LeftOut& left_out);

  [[nodiscard]] State rest(double y_m) const override;
  [[nodiscard]] State rate(const State& x, double u_V, double t_s) const override;
  /// The stiffest bristles against sliding need 5 us.
  [[nodiscard]] int steps() const override { return hidden.coulomb_N > 0.0 ? 1000 : 100; }

  AxisPlant plant;

 private:
  double mass_kg_;
};

}  // namespace truth
