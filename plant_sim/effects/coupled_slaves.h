// Slave actuators coupled to the rod through a needle valve: they move with it, and push their oil
// through the needle.
//
//   m_total = m + M,    F = D v + c v |v|
//
// M  mass of the slaves, kg         D  their linear damping, N/(m/s)
// c  needle valve: an orifice's pressure drop grows with the flow squared, N/(m/s)^2
// Source: the stand of Song (2002), chapter 6, which prints none of the three.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct CoupledSlaves {
  static constexpr const char* kName = "coupled_slaves";
  static constexpr const char* kEquation = "m_total = m + mass, F = damping v + needle v |v|";
  static constexpr std::array kSites = {Site::inertia, Site::force};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S mass_kg = 0.0;
    S damping_N_s_per_m = 0.0;
    S needle_N_s2_per_m2 = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"mass_kg", "mass that moves with the rod", 0.0, 1e5, 20.0, 0.0}, mass_kg);
      v(ParameterInfo{"damping_N_s_per_m", "linear damping", 0.0, 1e6, 2000.0, 0.0},
        damping_N_s_per_m);
      v(ParameterInfo{"needle_N_s2_per_m2", "quadratic damping", 0.0, 1e8, 1e4, 0.0},
        needle_N_s2_per_m2);
    }
  };
  struct Memory {};

  static S added_mass_kg(const Parameters& p) { return p.mass_kg; }

  static S resisting_N(const Parameters& p, const S& /*y_m*/, const S& v_mps) {
    return (p.damping_N_s_per_m + p.needle_N_s2_per_m2 * abs(v_mps)) * v_mps;
  }

  static S slope_N_s_per_m(const Parameters& p, const S& v_mps) {
    return p.damping_N_s_per_m + S(2.0) * p.needle_N_s2_per_m2 * abs(v_mps);
  }
};

}  // namespace plant_sim::effects
