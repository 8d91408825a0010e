// Resistance of passages that the moving rod pushes oil or air through.
//
//   F = c v |v|
//
// c  N/(m/s)^2     v  rod speed, m/s
// Source: turbulent orifice, Merritt, Hydraulic Control Systems (1967), chapter 3.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct QuadraticDamping {
  static constexpr const char* kName = "quadratic_damping";
  static constexpr const char* kEquation = "F = c v |v|";
  static constexpr std::array kSites = {Site::force};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S coefficient_N_s2_per_m2 = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"coefficient_N_s2_per_m2", "force per speed squared", 0.0, 1e8, 2e4, 0.0},
        coefficient_N_s2_per_m2);
    }
  };
  struct Memory {};

  static S resisting_N(const Parameters& p, const S& /*y_m*/, const S& v_mps) {
    return p.coefficient_N_s2_per_m2 * abs(v_mps) * v_mps;
  }

  static S slope_N_s_per_m(const Parameters& p, const S& v_mps) {
    return S(2.0) * p.coefficient_N_s2_per_m2 * abs(v_mps);
  }
};

}  // namespace plant_sim::effects
