// The parameters and states of hydraulic_actuator.h, each listed once.
#pragma once

#include "plant_sim/hydraulic_actuator.h"

namespace plant_sim {

template <class S>
template <class V>
void HydraulicActuator<S>::Parameters::visit(V&& v) {
  const auto field = [&](const char* name, const char* what, double least, double most,
                         double usual, S& value, double uncertainty_ratio = 0.0) {
    v(ParameterInfo{name, what, least, most, usual, usual, uncertainty_ratio}, value);
  };
  field("mass_kg", "moving mass m", 0.1, 1e6, 50.0, mass_kg, 0.05);
  field("area_m2", "piston area A, both sides", 1e-6, 1.0, 6.33e-4, area_m2);
  field("damping_N_s_per_m", "viscous damping d", 0.0, 1e8, 1000.0, damping_N_s_per_m, 0.2);
  field("bulk_modulus_Pa", "effective bulk modulus beta", 1e6, 1e11, 6.89e8, bulk_modulus_Pa, 0.1);
  field("dead_volume_m3", "volume V0 left at the stroke's end", 1e-8, 1.0, 1e-5, dead_volume_m3,
        0.2);
  field("stroke_m", "stroke L", 1e-3, 100.0, 0.61, stroke_m);
  field("supply_pressure_Pa", "supply pressure Ps", 0.0, 1e8, 6.89e6, supply_pressure_Pa, 0.03);
  field("return_pressure_Pa", "return pressure Pe", 0.0, 1e8, 0.0, return_pressure_Pa);
  field("discharge_coefficient", "orifice coefficient Cd", 1e-3, 2.0, 0.60, discharge_coefficient);
  field("density_kg_per_m3", "oil density rho", 100.0, 5000.0, 847.0, density_kg_per_m3);
  field("area_gradient_m", "orifice width w", 1e-6, 1.0, 2.07e-2, area_gradient_m);
  field("valve_gain_m_per_V", "spool travel per volt Kv", 0.0, 1.0, 2.79e-5, valve_gain_m_per_V,
        0.5);
  field("valve_natural_frequency_rad_per_s", "spool natural frequency wv", 1.0, 1e5, 628.0,
        valve_natural_frequency_rad_per_s, 0.07);
  field("valve_damping_ratio", "spool damping ratio zeta", 0.0, 10.0, 0.70, valve_damping_ratio,
        0.1);
}

template <class S>
template <class V>
void HydraulicActuator<S>::Initial::visit(V&& v) {
  const double unset = std::numeric_limits<double>::quiet_NaN();
  const auto field = [&](const char* name, const char* what, double least, double most,
                         double usual, S& value) {
    v(ParameterInfo{name, what, least, most, usual, usual}, value);
  };
  field("y_m", "rod position from the retracted stop", 0.0, 100.0, 0.305, y_m);
  field("v_mps", "rod speed", -100.0, 100.0, 0.0, v_mps);
  field("pressure_in_Pa", "chamber that extends; unset: half supply", 0.0, 1e8, unset,
        pressure_in_Pa);
  field("pressure_out_Pa", "chamber that retracts; unset: half supply", 0.0, 1e8, unset,
        pressure_out_Pa);
  field("spool_m", "spool position", -1.0, 1.0, 0.0, spool_m);
  field("spool_mps", "spool speed", -1e3, 1e3, 0.0, spool_mps);
}

template <class S>
template <class V>
void HydraulicActuator<S>::State::visit(V&& v) {
  v("y_m", y_m);
  v("v_mps", v_mps);
  v("pressure_in_Pa", in_Pa);
  v("pressure_out_Pa", out_Pa);
  v("spool_m", spool_m);
  v("spool_mps", spool_mps);
}

}  // namespace plant_sim
