// A cylinder with a cap side and a rod side behind a four-way proportional or servo valve, in the
// numbers of data sheets: four_way_cylinder.h with
//
//   Ai = cap area,   Ao = rod-side area,   Vi, Vo = oil between valve and piston at either end
//   Gi = QN / (xN sqrt(pN)),   Go = r Gi,   Kv = xN / uN
//   wv = 2 pi fB sqrt(k + sqrt(k^2 + 1)),   k = 2 zeta^2 - 1
//
//   QN, pN, uN, xN  rated flow at the rated drop of one edge, at the rated command, with the rated
//                   travel
//   r               rod side's opening over the cap side's, of a spool cut for unequal areas
//   fB, zeta        frequency at which the spool's amplitude has fallen by 3 dB; damping ratio
//
// The axis is inclined by a: upwards when it extends for a > 0, with the weight m g sin a. A spool
// with a damping ratio of 10 or more is a first-order lag of the rate wv / (2 zeta), which delays
// as much: its faster pole, 400 times as fast and more, is left out. xN is of no influence on
// command, position and pressures: it gives spool_m and the parameters of effects in metres of
// spool travel a scale.
//
// Sources: ISO 10770-1 (2009) for the valve's numbers; Jelali and Kroll, Hydraulic Servo-systems
// (2003), chapter 4.
#pragma once

#include "plant_sim/four_way_cylinder.h"
#include "plant_sim/guard.h"

namespace plant_sim {

template <class S>
struct TwoAreaDesign {
  static constexpr bool kEqualSides = false;
  static constexpr const char* kGainParameter = "rated_flow_m3ps";
  static constexpr double kStart_m = 0.25;

  /// A bore of 50 mm and a rod of 32 mm behind a proportional valve of 40 l/min at 35 bar an edge.
  struct Parameters {
    S mass_kg = 200.0;
    S cap_area_m2 = 1.963e-3;
    S rod_side_area_m2 = 1.159e-3;
    S damping_N_s_per_m = 2000.0;
    S bulk_modulus_Pa = 1.2e9;
    S cap_dead_volume_m3 = 2e-4;
    S rod_dead_volume_m3 = 2e-4;
    S stroke_m = 0.5;
    S inclination_rad = 0.0;
    S supply_pressure_Pa = 1.4e7;
    S return_pressure_Pa = 3e5;
    S rated_flow_m3ps = 6.667e-4;
    S rated_drop_Pa = 3.5e6;
    S rated_command_V = 10.0;
    S rated_travel_m = 1e-3;
    S valve_area_ratio = 1.0;
    S valve_bandwidth_Hz = 20.0;
    S valve_damping_ratio = 1.0;
    S retracted_cushion_length_m = 0.0;
    S retracted_cushion_flow_m3ps = 2e-5;
    S extended_cushion_length_m = 0.0;
    S extended_cushion_flow_m3ps = 2e-5;

    template <class V>
    void visit(V&& v) {
      const auto field = [&](const char* name, const char* what, double least, double most,
                             double usual, S& value, double uncertainty_ratio = 0.0) {
        v(ParameterInfo{name, what, least, most, usual, usual, uncertainty_ratio}, value);
      };
      field("mass_kg", "moving mass m, piston and load", 0.1, 1e6, 200.0, mass_kg, 0.2);
      field("cap_area_m2", "piston area, cap side", 1e-6, 1.0, 1.963e-3, cap_area_m2);
      field("rod_side_area_m2", "piston area less the rod's", 1e-6, 1.0, 1.159e-3,
            rod_side_area_m2);
      field("damping_N_s_per_m", "viscous damping d", 0.0, 1e8, 2000.0, damping_N_s_per_m, 0.5);
      field("bulk_modulus_Pa", "effective bulk modulus beta of oil and hoses", 1e6, 1e11, 1.2e9,
            bulk_modulus_Pa, 0.3);
      field("cap_dead_volume_m3", "oil between valve and piston, cap side, fully retracted", 1e-8,
            1.0, 2e-4, cap_dead_volume_m3, 0.3);
      field("rod_dead_volume_m3", "oil between valve and piston, rod side, fully extended", 1e-8,
            1.0, 2e-4, rod_dead_volume_m3, 0.3);
      field("stroke_m", "stroke L", 1e-3, 100.0, 0.5, stroke_m);
      field("inclination_rad", "of the axis, upwards when it extends; pi/2 lifts its mass", -1.5708,
            1.5708, 0.0, inclination_rad);
      field("supply_pressure_Pa", "supply pressure Ps", 0.0, 1e8, 1.4e7, supply_pressure_Pa, 0.05);
      field("return_pressure_Pa", "return pressure Pe", 0.0, 1e8, 3e5, return_pressure_Pa);
      field("rated_flow_m3ps", "flow of the cap side's edge at rated drop and command", 1e-9, 1.0,
            6.667e-4, rated_flow_m3ps, 0.3);
      field("rated_drop_Pa", "drop over one edge at which the flow is rated", 1e3, 1e8, 3.5e6,
            rated_drop_Pa);
      field("rated_command_V", "command at which the flow is rated", 1e-3, 1e4, 10.0,
            rated_command_V);
      field("rated_travel_m", "spool travel at the rated command", 1e-6, 0.1, 1e-3, rated_travel_m);
      field("valve_area_ratio", "rod side's opening over the cap side's", 0.01, 100.0, 1.0,
            valve_area_ratio);
      field("valve_bandwidth_Hz", "frequency at which the spool follows by -3 dB", 0.01, 1e4, 20.0,
            valve_bandwidth_Hz, 0.5);
      field("valve_damping_ratio", "spool damping ratio zeta; from 10 a first-order lag", 0.1,
            100.0, 1.0, valve_damping_ratio, 0.5);
      field("retracted_cushion_length_m", "end cushion before the retracted stop; 0 is none", 0.0,
            100.0, 0.0, retracted_cushion_length_m);
      field("retracted_cushion_flow_m3ps", "flow that its throttle lets out at the rated drop", 0.0,
            1.0, 2e-5, retracted_cushion_flow_m3ps);
      field("extended_cushion_length_m", "end cushion before the extended stop; 0 is none", 0.0,
            100.0, 0.0, extended_cushion_length_m);
      field("extended_cushion_flow_m3ps", "flow that its throttle lets out at the rated drop", 0.0,
            1.0, 2e-5, extended_cushion_flow_m3ps);
    }
  };

  static CylinderSide<S> in_side(const Parameters& p) {
    return {p.cap_area_m2, p.cap_dead_volume_m3,
            p.rated_flow_m3ps / (p.rated_travel_m * sqrt(p.rated_drop_Pa))};
  }

  static CylinderSide<S> out_side(const Parameters& p) {
    return {p.rod_side_area_m2, p.rod_dead_volume_m3, in_side(p).orifice * p.valve_area_ratio};
  }

  static EndCushions<S> cushions(const Parameters& p) {
    const S per_flow = S(1.0) / sqrt(p.rated_drop_Pa);
    return {p.retracted_cushion_length_m, p.extended_cushion_length_m,
            per_flow * p.retracted_cushion_flow_m3ps, per_flow * p.extended_cushion_flow_m3ps};
  }

  static SpoolDynamics<S> spool(const Parameters& p, double step_s) {
    constexpr double kTwoPi = 6.283185307179586;
    constexpr double kFirstOrder = 10.0;
    // rate times the step that the finest division of a step follows
    constexpr double kResolved = limits::kRateStep * limits::kMostDivisions;
    const S zeta = p.valve_damping_ratio;
    const S k = S(2.0) * zeta * zeta - S(1.0);
    const S wv = S(kTwoPi) * p.valve_bandwidth_Hz * sqrt(k + sqrt(k * k + S(1.0)));
    const S fast = S(2.0) * zeta * wv;
    const auto lags = max(zeta * S(1.0 / kFirstOrder), fast * S(step_s / kResolved)) >= S(1.0);
    const S zero = 0.0;
    return {p.rated_travel_m / p.rated_command_V, select(lags, zero, wv), select(lags, zero, fast),
            select(lags, min(wv / (S(2.0) * zeta), S(kResolved / step_s)), zero)};
  }

  static S weight_N(const Parameters& p, const S& mass_kg) {
    constexpr double kGravity_mps2 = 9.80665;
    return mass_kg * S(kGravity_mps2) * sin(p.inclination_rad);
  }
};

template <class S>
class HydraulicCylinder final : public FourWayCylinder<S, TwoAreaDesign<S>> {
 public:
  static constexpr const char* kName = "hydraulic_cylinder";
};

}  // namespace plant_sim
