// A constant force on the rod: weight, preload.
//
//   F = force
//
// force  N, positive resists extension
// Source: Newton's second law.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct LoadForce {
  static constexpr const char* kName = "load_force";
  static constexpr const char* kEquation = "F = force";
  static constexpr std::array kSites = {Site::force};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S force_N = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"force_N", "constant force, positive resists extension", -1e7, 1e7, 500.0,
                      0.0},
        force_N);
    }
  };
  struct Memory {};

  static S resisting_N(const Parameters& p, const S& /*y_m*/, const S& /*v_mps*/) {
    return p.force_N;
  }
};

}  // namespace plant_sim::effects
