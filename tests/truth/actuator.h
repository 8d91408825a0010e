// The actuator of Song (2002) with hidden effects, written apart from plant_sim and integrated in
// another way, so that the diagnosis is judged on data that its own model did not make.
//
//   y' = v                    (m + M) v' = A (Pi - Po) - d v - F
//   Pi' = beta_i / (V0 + A y)       (Qi - A v - Ci (Pi - Po) - Ce Pi)
//   Po' = beta_o / (V0 + A (L - y)) (A v - Qo + Ci (Pi - Po) - Ce Po)
//   xv'' = wv^2 (Kv u - xv) - 2 zeta wv xv'
//   friction (LuGre): z' = v - s0 |v| z / g(v),  F = s0 z + s1 z',
//                     g = Fc (1 +- r) + (Fs - Fc)+ exp(-(v/vs)^2)
//
// Heun's method with a fixed step of 25 us (12.5 us with friction). Orifices are plain signed
// square roots; pressures are floored at zero. Symbols as in the thesis, effects as in the
// product's library; Hidden lists them with the parameter names of the product.
// Sources: Song (2002) chapter 4; Canudas de Wit, Olsson, Astrom, Lischinsky (1995) for LuGre;
// Merritt (1967) for valve, leakage, supply and oil.
#pragma once

#include <array>
#include <limits>

#include "tests/truth/left_out.h"

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

/// Every effect of the library, at values without influence.
struct Hidden {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double delay_s = 0.0;
  double null_bias_V = 0.0;
  double hysteresis_V = 0.0;  ///< half the width of the play
  double spool_rate_mps = kNone;
  double deadband_V = 0.0;  ///< half width
  double asymmetry_ratio = 0.0;
  double flow_limit_m3ps = kNone;
  double droop_Pa_per_m3ps = 0.0;
  double internal_m3ps_per_Pa = 0.0;
  double external_m3ps_per_Pa = 0.0;
  double air_ratio = 0.0;
  double coulomb_N = 0.0;
  double static_N = 0.0;
  double stribeck_mps = 0.01;
  double presliding_N_per_m = 1e7;   ///< s0: rigid contact is not in LuGre; this is as good as it
  double bristle_N_s_per_m = 700.0;  ///< s1, which the product does not know
  double direction_ratio = 0.0;
  double quadratic_N_s2_per_m2 = 0.0;
  double spring_N_per_m = 0.0;
  double rest_m = 0.305;
  double force_N = 0.0;
  double ripple_N = 0.0;
  double ripple_wavelength_m = 0.01;
  double ripple_phase_rad = 0.0;
  double slaves_kg = 0.0;
  double slaves_N_s_per_m = 0.0;
  double needle_N_s2_per_m2 = 0.0;
  double backlash_m = 0.0;  ///< whole width
  double eccentricity_m = 0.0;
  double eccentricity_wavelength_m = 0.02;
  double eccentricity_phase_rad = 0.0;
};

/// y, v, Pi, Po, spool, spool speed, bristle deflection.
using State = std::array<double, 7>;

/// LuGre's sliding level g(v), N.
double sliding_level_N(const Hidden& hidden, double v_mps);

class Actuator {
 public:
  Actuator(const Plant& plant, const Hidden& hidden, const LeftOut& left_out);

  /// At y_m, at rest, half the supply pressure in both chambers.
  [[nodiscard]] State rest(double y_m) const;
  /// The time derivative of the state; u_V is what reaches the spool.
  [[nodiscard]] State rate(const State& x, double u_V, double t_s) const;
  /// One step of Heun's method.
  void step(State& x, double u_V, double t_s, double step_s) const;
  /// Supply pressure at the valve: what the flow drawn leaves of it.
  [[nodiscard]] double inlet_Pa(const State& x, double t_s) const;
  /// Force of the bristles.
  [[nodiscard]] double friction_N(double z_m, double v_mps) const;

  Plant plant;
  Hidden hidden;
  LeftOut left_out;
  /// From outside, as they are now.
  double outside_N = 0.0;
  double outside_Pa = 0.0;

 private:
  [[nodiscard]] double bristle_rate_mps(double z_m, double v_mps) const;
  [[nodiscard]] double resisting_N(double y_m, double v_mps, double t_s) const;
  [[nodiscard]] double opening_m(double spool_m, double y_m, double t_s) const;
  [[nodiscard]] double modulus_Pa(double pressure_Pa) const;
  /// Magnitude of the flow drawn from the supply against port_Pa through k.
  [[nodiscard]] double drawn_m3ps(double k, double supply_Pa, double port_Pa) const;

  double orifice_;  ///< Cd w sqrt(2/rho)
  double mass_kg_;
};

}  // namespace truth
