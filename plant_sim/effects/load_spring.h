// The rod works against a spring: a specimen, a fixture.
//
//   F = k (y - rest)
//
// k  N/m     y  rod position, rest  where the spring is without force, m
// Source: Hooke's law.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct LoadSpring {
  static constexpr const char* kName = "load_spring";
  static constexpr const char* kEquation = "F = k (y - rest)";
  static constexpr std::array kSites = {Site::force};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S stiffness_N_per_m = 0.0;
    S rest_m = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"stiffness_N_per_m", "stiffness of the load", 0.0, 1e9, 2e4, 0.0},
        stiffness_N_per_m);
      v(ParameterInfo{"rest_m", "position without force", -100.0, 100.0, 0.3, 0.0}, rest_m);
    }
  };
  struct Memory {};

  static S resisting_N(const Parameters& p, const S& y_m, const S& /*v_mps*/) {
    return p.stiffness_N_per_m * (y_m - p.rest_m);
  }

  static S stiffness_N_per_m(const Parameters& p) { return p.stiffness_N_per_m; }
};

}  // namespace plant_sim::effects
