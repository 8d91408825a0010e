// A double-rod cylinder behind a critical-centre four-way servovalve: the six states of Song
// (2002), chapter 4.
//
//   y'  = v
//   m v' = A (Pi - Po) - d v - F
//   Pi' = beta / (V0 + A y)       (Qi - A v)
//   Po' = beta / (V0 + A (L - y)) (A v - Qo)
//   xv'' = -2 zeta wv xv' - wv^2 xv + Kv wv^2 u
//   xv >= 0: Qi = G xv q(Ps - Pi),  Qo = G xv q(Po - Pe)
//   xv <  0: Qi = G xv q(Pi - Pe),  Qo = G xv q(Ps - Po)      G = Cd w sqrt(2/rho)
//
// y v rod position and speed; Pi Po chamber pressures; xv spool position; u command. The command
// chain ahead of xv, the opening behind it, supply, flows, beta, m and F are where effects act.
// Beyond the thesis, and without a bit of influence inside the stroke at ordinary pressures:
// - q(p) = sign(p) sqrt|p|, and under 1 bar a cubic through zero with the same value and slope at
//   1 bar: a reversed orifice flows back, and the slope stays finite.
// - End stops are inelastic: at y = 0 and y = L the rod loses its speed and is held while pushed
//   outward. V0 > 0 and y within the stroke keep the volumes away from zero.
// - Cavitation: pressures are counted from vapour pressure and do not fall below 0. The vapour's
//   volume is not kept: when the rod returns, pressure rises at once, so oil is not conserved
//   there.
// - Where the equations are stiffer than the step can follow (a chamber near the stroke's end, an
//   orifice near zero drop), the step is divided, in each lane by its own number.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/coupled_step.h"
#include "plant_sim/effects/table.h"
#include "plant_sim/pressures.h"

namespace plant_sim {

template <class S>
class HydraulicActuator {
 public:
  static constexpr const char* kName = "hydraulic_actuator";
  static constexpr std::array kSites = {
      effects::Site::command,      effects::Site::spool,   effects::Site::opening,
      effects::Site::supply,       effects::Site::flow,    effects::Site::leakage,
      effects::Site::bulk_modulus, effects::Site::inertia, effects::Site::force,
      effects::Site::dry_friction, effects::Site::sensor,  effects::Site::coupling};

  /// The printed values (source, table 5.1); V0 is not printed and of no influence there.
  struct Parameters {
    S mass_kg = 50.0;
    S area_m2 = 6.33e-4;
    S damping_N_s_per_m = 1000.0;
    S bulk_modulus_Pa = 6.89e8;
    S dead_volume_m3 = 1e-5;
    S stroke_m = 0.61;
    S supply_pressure_Pa = 6.89e6;
    S return_pressure_Pa = 0.0;
    S discharge_coefficient = 0.60;
    S density_kg_per_m3 = 847.0;
    S area_gradient_m = 2.07e-2;
    S valve_gain_m_per_V = 2.79e-5;
    S valve_natural_frequency_rad_per_s = 628.0;
    S valve_damping_ratio = 0.70;

    template <class V>
    void visit(V&& v);
  };

  /// Rod and spool at the start; pressures that are NaN start half way between supply and return.
  struct Initial {
    S y_m = 0.305;
    S v_mps = 0.0;
    S pressure_in_Pa = std::numeric_limits<double>::quiet_NaN();
    S pressure_out_Pa = std::numeric_limits<double>::quiet_NaN();
    S spool_m = 0.0;
    S spool_mps = 0.0;

    template <class V>
    void visit(V&& v);
  };

  struct State {
    S y_m, v_mps, in_Pa, out_Pa, spool_m, spool_mps;

    State moved(const State& rate, const S& by) const {
      return {y_m + by * rate.y_m,         v_mps + by * rate.v_mps,
              in_Pa + by * rate.in_Pa,     out_Pa + by * rate.out_Pa,
              spool_m + by * rate.spool_m, spool_mps + by * rate.spool_mps};
    }
    friend State operator+(const State& a, const State& b) { return a.moved(b, S(1.0)); }

    template <class V>
    void visit(V&& v);
  };

  Parameters parameters;
  Initial initial;
  State state;
  effects::Effects<S> effects;

  /// Resets to the initial state; parameters are kept.
  void reset();
  /// Call before step() after any parameter has changed, with the length of the step.
  void prepare(double step_s);
  /// One step with u_V held; u_V that is not a number counts as 0.
  void step(const S& u_V);

  [[nodiscard]] S speed_mps() const { return state.v_mps; }
  [[nodiscard]] PressuresOf<S> pressures() const;

  /// The equations above, inside the stroke (kLimits false) or with its ends and cavitation, and
  /// with the active effects or as if there were none; pull_mps2: by the spring of a second mass.
  template <bool kLimits, bool kEffects>
  State rate(const State& x, const S& u_V, const S& from_y_m, const S& pull_mps2 = S(0.0)) const;

 private:
  struct Derived {
    S orifice, two_zeta_wv, wv2, kv_wv2, mass_kg, inverse_mass, arrest_kg_per_s, steady_rate;
    S spool_limit_mps, stiffness_N_per_m, conductance_m3ps_per_Pa;
    double step_s;
  };
  struct Flows {
    S in_m3ps;   ///< into the chamber that extends
    S out_m3ps;  ///< out of the chamber that retracts
  };
  static S root(const S& drop_Pa);
  template <bool kEffects>
  S valve_flow(const State& x) const;
  template <bool kEffects>
  S inlet_Pa(const State& x, const S& flow) const;
  template <bool kEffects>
  Flows flows(const State& x) const;
  S reach_m(const S& u_V) const;
  S fast_mps() const;
  S spool_reach_mps(const S& u_V) const;
  auto ordinary(const S& u_V) const;
  S divisions(const S& u_V) const;
  template <bool kLimits, bool kEffects>
  void integrate(const S& u_V, const S& step_s);
  void keep_within_limits();

  Derived derived_;
};

}  // namespace plant_sim

#include "plant_sim/hydraulic_actuator_equations.h"
#include "plant_sim/hydraulic_actuator_fields.h"
#include "plant_sim/hydraulic_actuator_step.h"
