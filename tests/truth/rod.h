// A single-rod cylinder behind a proportional valve: it extends and retracts at different speeds.
//
//   m v' = A1 P1 - A2 P2 - d v - F      xv'' = wv^2 (u - xv) - 2 zeta wv xv'   (xv in volts)
//   P1' = beta/(V0 + A1 y)       (Q1 - A1 v)
//   P2' = beta/(V0 + A2 (L - y)) (A2 v - Q2)
//   extending, o > 0:  Q1 = K o root(Ps' - P1),  Q2 = K o root(P2 - Pt);  retracting: supply on P2
//
// o: xv behind the overlap. Ps' = Ps - droop * flow drawn. Steady, with a load F:
//   v = K o root((A1 Ps - A2 Pt - F)/(A1^3 + A2^3))  out,  root((A2 Ps - A1 Pt + F)/...)  in
// so their ratio is that of areas and load alone, whatever the valve: what a servo known only by
// command and position shows as an asymmetry. Source: Merritt (1967), Jelali and Kroll (2003).
#pragma once

#include "tests/truth/machine.h"

namespace truth {

struct RodPlant {
  double mass_kg = 200.0;
  double area_cap_m2 = 20e-4;
  double area_rod_m2 = 12e-4;
  double damping_N_s_per_m = 3000.0;
  double bulk_modulus_Pa = 1.2e9;
  double dead_volume_m3 = 2e-4;
  double stroke_m = 0.61;
  double supply_pressure_Pa = 1.4e7;
  double return_pressure_Pa = 3e5;
  double flow_m3ps_per_V_rootPa = 3.56e-8;  ///< K: 40 l/min at 35 bar an edge and 10 V
  double valve_natural_frequency_rad_per_s = 150.0;
  double valve_damping_ratio = 0.8;
};

/// (out - in)/(out + in) of the steady speeds per opening, without droop and damping.
double speed_asymmetry(const RodPlant& plant, double load_N);

/// State: y, v, P1, P2, spool and its speed in volts, bristle deflection.
class Rod : public Machine {
 public:
  Rod(const RodPlant& plant, const Hidden& hidden, const LeftOut& left_out);

  /// P1 and P2 in balance with the load.
  [[nodiscard]] State rest(double y_m) const override;
  [[nodiscard]] State rate(const State& x, double u_V, double t_s) const override;
  [[nodiscard]] int steps() const override { return hidden.coulomb_N > 0.0 ? 400 : 200; }
  [[nodiscard]] double supply_Pa() const override { return plant.supply_pressure_Pa; }

  RodPlant plant;

 protected:
  void bound(State& x) const override;
};

}  // namespace truth
