// A cylinder behind a critical-centre four-way valve: the equations that hydraulic_actuator (equal
// areas, after Song (2002), chapter 4) and hydraulic_cylinder (two areas) share.
//
//   y'  = v
//   m v' = Ai Pi - Ao Po - d v - m g sin(a) - F
//   Pi' = beta / (Vi + Ai y)       (Qi - Ai v)
//   Po' = beta / (Vo + Ao (L - y)) (Ao v - Qo)
//   xv'' = -2 zeta wv xv' - wv^2 xv + Kv wv^2 u
//   xv >= 0: Qi = Gi xv q(Ps - Pi),  Qo = Go xv q(Po - Pe)
//   xv <  0: Qi = Gi xv q(Pi - Pe),  Qo = Go xv q(Ps - Po)
//
// and of a valve whose edges are open at null, by an underlap U or a leakage, with a+ = A(xv + U)
// and a- = A(U - xv), A(e) = max(e, 0) or, of edges that leak, more,
//
//   Qi = Gi (a+ q(Ps - Pi) - a- q(Pi - Pe)),   Qo = Go (a+ q(Po - Pe) - a- q(Ps - Po))
//
// y v rod position and speed; Pi Po pressures of the chambers that extend and retract the rod, Ai
// Ao their areas, Vi Vo their volumes at the end of the stroke; Gi Go flow of a port per opening
// and root of the drop; a inclination of the axis; xv spool position; u command. The command chain
// ahead of xv, the opening behind it, supply, flows, beta, m and F are where effects act. Beyond
// these, and without a bit of influence inside the stroke at ordinary pressures:
// - q(p) = sign(p) sqrt|p|, and under 1 bar a cubic through zero with the same value and slope at
//   1 bar: a reversed orifice flows back, and the slope stays finite.
// - End stops are inelastic: at y = 0 and y = L the rod loses its speed and is held while pushed
//   outward. Vi, Vo > 0 and y within the stroke keep the volumes away from zero.
// - End cushions, where the parameters give their length: oil that leaves a chamber on the last way
//   to its stop passes a throttle Gc in series with the valve's edges Gv, so that
//     1/G^2 = 1/Gv^2 + 1/Gc^2
//   and the chamber's pressure builds up until the rod is slow. Oil that enters passes a check
//   valve beside the throttle. Dead volume and area count as the cushion's: the spear's own area
//   and the oil between throttle and valve are left out.
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

/// Constants of one side of the cylinder, computed from the plant's parameters.
template <class S>
struct CylinderSide {
  S area_m2;
  S dead_volume_m3;
  S orifice;  ///< flow of the port per opening and root of the drop, m3/s/(m sqrt(Pa))
};

/// Constants of the cushions at the ends of the stroke, computed from the plant's parameters.
template <class S>
struct EndCushions {
  S retracted_m, extended_m;  ///< way before the stop on which the throttle acts; 0: no cushion
  S retracted, extended;      ///< flow of the throttle per root of the drop, m3/s/sqrt(Pa)
};

/// Constants of the valve's spool, computed from the plant's parameters.
template <class S>
struct SpoolDynamics {
  S gain_m_per_V;
  S wv_rad_per_s;
  S two_zeta_wv_per_s;
  S lag_rate_per_s;  ///< rate of the first-order lag that stands for the spool; 0: second order
};

/// `Design` names the parameters (Parameters) and says what they mean:
///   bool kEqualSides              same area, volume and orifice on both sides, on a level axis
///   in_side(p), out_side(p)       CylinderSide<S>
///   cushions(p)                   EndCushions<S>
///   spool(p, step_s)              SpoolDynamics<S>
///   const char* kGainParameter    the parameter that stands for the valve's size
///   weight_N(p, mass_kg)          force against extension, unless kEqualSides
/// Parameters have mass_kg, damping_N_s_per_m, bulk_modulus_Pa, stroke_m, supply_pressure_Pa and
/// return_pressure_Pa beside those of the design.
template <class S, class Design>
class FourWayCylinder {
 public:
  static constexpr std::array kSites = {
      effects::Site::command,      effects::Site::amplifier, effects::Site::spool,
      effects::Site::opening,      effects::Site::lap,       effects::Site::edge,
      effects::Site::supply,       effects::Site::flow,      effects::Site::leakage,
      effects::Site::bulk_modulus, effects::Site::inertia,   effects::Site::force,
      effects::Site::dry_friction, effects::Site::sensor,    effects::Site::coupling};

  using PlantDesign = Design;
  using Parameters = typename Design::Parameters;

  /// Rod and spool at the start. Pressures that are NaN start at rest: half way between supply and
  /// return where both sides are equal, otherwise in balance with weight and load (rest_Pa).
  struct Initial {
    S y_m = Design::kStart_m;
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
  S disturbance_N = 0.0;                 ///< force against extension from outside of the model
  S disturbance_place = kPlaceOfSensor;  ///< as disturbed_parts()

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
    CylinderSide<S> in, out;
    EndCushions<S> cushions;
    bool cushioned;
    S most_arrest_kg_per_s;
    effects::ContactLevels<S> contact;
    bool brakes, turns_gradually, yields;
    DisturbedParts<S> disturbed;
    S valve_gain_m_per_V, most_orifice;
    S two_zeta_wv, wv2, kv_wv2, lag_rate, mass_kg, inverse_mass, steady_rate;
    S weight_N;
    S spool_limit_mps, stiffness_N_per_m, conductance_m3ps_per_Pa;
    double step_s;
  };
  struct Volumes {
    S in_m3;
    S out_m3;
  };
  struct Flows {
    S in_m3ps;   ///< into the chamber that extends
    S out_m3ps;  ///< out of the chamber that retracts
  };
  /// Openings of the edges of a valve that is open at null.
  struct Edges {
    S ahead_m;  ///< those that extend the rod: Ps to chamber i, chamber o to Pe
    S back_m;   ///< those that retract it: Ps to chamber o, chamber i to Pe
  };
  static S root(const S& drop_Pa);
  formula::Motion<S> motion(const State& x) const {
    return {drive_V_, x.y_m, x.v_mps, x.spool_m, x.in_Pa, x.out_Pa};
  }
  [[nodiscard]] const CylinderSide<S>& in_side() const { return derived_.in; }
  [[nodiscard]] const CylinderSide<S>& out_side() const {
    return Design::kEqualSides ? derived_.in : derived_.out;
  }
  Volumes volumes(const S& y_m) const;
  S pressure_force_N(const State& x) const;
  void rest_pressures(State& x) const;
  template <bool kEffects>
  S opening_m(const State& x) const;
  Edges edges(const S& opening_m) const;
  template <bool kEffects>
  S inlet_Pa(const State& x, const S& opening_m) const;
  Flows lapped_flows(const State& x, const S& opening_m) const;
  static S cushion_ratio(const S& edge, const S& throttle);
  template <bool kEffects>
  void throttle_ends(const State& x, const S& opening_m, Flows& q) const;
  template <bool kEffects>
  Flows flows(const State& x) const;
  S reach_m(const S& u_V) const;
  S fast_mps() const;
  S free_N() const;
  void take_contact();
  S slow_mps(const S& free_N) const;
  S spool_reach_mps(const S& u_V) const;
  auto ordinary(const S& u_V) const;
  S divisions(const S& u_V) const;
  template <bool kLimits, bool kEffects>
  void integrate(const S& u_V, const S& step_s);
  void keep_within_limits();

  Derived derived_;
  S arrest_kg_per_s_;  ///< DryContact::arrest_kg_per_s of the present step
  S drive_V_ = 0.0;    ///< command behind the effects of the command, held through the step
};

}  // namespace plant_sim

#include "plant_sim/four_way_cylinder_equations.h"
#include "plant_sim/four_way_cylinder_fields.h"
#include "plant_sim/four_way_cylinder_step.h"
