// The actuator of Song (2002) with hidden effects, written apart from plant_sim and integrated in
// another way, so that the diagnosis is judged on data that its own model did not make.
//
//   y' = v                    (m + M) v' = A (Pi - Po) - d v - F
//   Pi' = beta_i / (V0 + A y)       (Qi - A v - Ci (Pi - Po) - Ce Pi)
//   Po' = beta_o / (V0 + A (L - y)) (A v - Qo + Ci (Pi - Po) - Ce Po)
//   xv'' = wv^2 (Kv u - xv) - 2 zeta wv xv'
//
// The step is 25 us (12.5 us with friction). Orifices are plain signed square roots; pressures are
// floored at zero. Symbols as in the thesis, effects as in the product's library (hidden.h).
// Sources: Song (2002) chapter 4; Merritt (1967) for valve, leakage, supply and oil.
#pragma once

#include "tests/truth/machine.h"

namespace truth {

/// The plant as built: the printed values, which a record's own differ from.
struct Plant {
  double mass_kg = 50.0;
  double area_m2 = 6.33e-4;
  double damping_N_s_per_m = 1000.0;
  double bulk_modulus_Pa = 6.89e8;
  double dead_volume_m3 = 1e-5;
  double stroke_m = 0.61;
  double supply_pressure_Pa = 6.89e6;
  double return_pressure_Pa = 0.0;
  double discharge_coefficient = 0.60;
  double density_kg_per_m3 = 847.0;
  double area_gradient_m = 2.07e-2;
  double valve_gain_m_per_V = 2.79e-5;
  double valve_natural_frequency_rad_per_s = 628.0;
  double valve_damping_ratio = 0.70;
};

/// State: y, v, Pi, Po, spool, spool speed, bristle deflection.
class Actuator : public Machine {
 public:
  Actuator(const Plant& plant, const Hidden& hidden, const LeftOut& left_out);

  /// Half the supply pressure in both chambers.
  [[nodiscard]] State rest(double y_m) const override;
  [[nodiscard]] State rate(const State& x, double u_V, double t_s) const override;
  [[nodiscard]] int steps() const override { return hidden.coulomb_N > 0.0 ? 400 : 200; }
  [[nodiscard]] double supply_Pa() const override { return plant.supply_pressure_Pa; }
  [[nodiscard]] double inlet_Pa(const State& x, double t_s) const override;

  Plant plant;

 protected:
  void bound(State& x) const override;

 private:
  [[nodiscard]] double opening_m(double spool_m, double y_m, double t_s) const;
  [[nodiscard]] double modulus_Pa(double pressure_Pa) const;

  double orifice_;  ///< Cd w sqrt(2/rho)
  double mass_kg_;
};

}  // namespace truth
