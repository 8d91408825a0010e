// A double-rod cylinder behind a critical-centre four-way servovalve: the six states of Song
// (2002), chapter 4, as four_way_cylinder.h with
//
//   Ai = Ao = A,   Vi = Vo = V0,   Gi = Go = Cd w sqrt(2/rho),   a = 0
//
// w width of the orifices, Cd their discharge coefficient, rho density of the oil.
#pragma once

#include "plant_sim/four_way_cylinder.h"

namespace plant_sim {

template <class S>
struct DoubleRodDesign {
  static constexpr bool kEqualSides = true;
  static constexpr const char* kGainParameter = "valve_gain_m_per_V";
  static constexpr double kStart_m = 0.305;

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
    S retracted_cushion_length_m = 0.0;
    S retracted_cushion_orifice_m2 = 1e-6;
    S extended_cushion_length_m = 0.0;
    S extended_cushion_orifice_m2 = 1e-6;

    template <class V>
    void visit(V&& v) {
      const auto field = [&](const char* name, const char* what, double least, double most,
                             double usual, S& value, double uncertainty_ratio = 0.0) {
        v(ParameterInfo{name, what, least, most, usual, usual, uncertainty_ratio}, value);
      };
      field("mass_kg", "moving mass m", 0.1, 1e6, 50.0, mass_kg, 0.05);
      field("area_m2", "piston area A, both sides", 1e-6, 1.0, 6.33e-4, area_m2);
      field("damping_N_s_per_m", "viscous damping d", 0.0, 1e8, 1000.0, damping_N_s_per_m, 0.2);
      field("bulk_modulus_Pa", "effective bulk modulus beta", 1e6, 1e11, 6.89e8, bulk_modulus_Pa,
            0.1);
      field("dead_volume_m3", "volume V0 left at the stroke's end", 1e-8, 1.0, 1e-5, dead_volume_m3,
            0.2);
      field("stroke_m", "stroke L", 1e-3, 100.0, 0.61, stroke_m);
      field("supply_pressure_Pa", "supply pressure Ps", 0.0, 1e8, 6.89e6, supply_pressure_Pa, 0.03);
      field("return_pressure_Pa", "return pressure Pe", 0.0, 1e8, 0.0, return_pressure_Pa);
      field("discharge_coefficient", "orifice coefficient Cd", 1e-3, 2.0, 0.60,
            discharge_coefficient);
      field("density_kg_per_m3", "oil density rho", 100.0, 5000.0, 847.0, density_kg_per_m3);
      field("area_gradient_m", "orifice width w", 1e-6, 1.0, 2.07e-2, area_gradient_m);
      field("valve_gain_m_per_V", "spool travel per volt Kv", 0.0, 1.0, 2.79e-5, valve_gain_m_per_V,
            0.5);
      field("valve_natural_frequency_rad_per_s", "spool natural frequency wv", 1.0, 1e5, 628.0,
            valve_natural_frequency_rad_per_s, 0.07);
      field("valve_damping_ratio", "spool damping ratio zeta", 0.0, 10.0, 0.70, valve_damping_ratio,
            0.1);
      field("retracted_cushion_length_m", "end cushion before the retracted stop; 0 is none", 0.0,
            100.0, 0.0, retracted_cushion_length_m);
      field("retracted_cushion_orifice_m2", "area of its throttle", 0.0, 1.0, 1e-6,
            retracted_cushion_orifice_m2);
      field("extended_cushion_length_m", "end cushion before the extended stop; 0 is none", 0.0,
            100.0, 0.0, extended_cushion_length_m);
      field("extended_cushion_orifice_m2", "area of its throttle", 0.0, 1.0, 1e-6,
            extended_cushion_orifice_m2);
    }
  };

  static CylinderSide<S> in_side(const Parameters& p) {
    return {p.area_m2, p.dead_volume_m3,
            p.discharge_coefficient * p.area_gradient_m * sqrt(S(2.0) / p.density_kg_per_m3)};
  }

  static EndCushions<S> cushions(const Parameters& p) {
    const S per_m2 = p.discharge_coefficient * sqrt(S(2.0) / p.density_kg_per_m3);
    return {p.retracted_cushion_length_m, p.extended_cushion_length_m,
            per_m2 * p.retracted_cushion_orifice_m2, per_m2 * p.extended_cushion_orifice_m2};
  }

  static SpoolDynamics<S> spool(const Parameters& p, double /*step_s*/) {
    const S wv = p.valve_natural_frequency_rad_per_s;
    return {p.valve_gain_m_per_V, wv, S(2.0) * p.valve_damping_ratio * wv, S(0.0)};
  }
};

template <class S>
class HydraulicActuator final : public FourWayCylinder<S, DoubleRodDesign<S>> {
 public:
  static constexpr const char* kName = "hydraulic_actuator";
};

}  // namespace plant_sim
