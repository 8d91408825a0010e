// Laminar leakage past the piston, from the chamber at higher pressure to the other.
//
//   Q = C (Pi - Po)     out of chamber i, into chamber o
//
// C  conductance, m3/s per Pa      Pi Po  chamber pressures, Pa
// Source: Merritt, Hydraulic Control Systems (1967), chapter 6.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct InternalLeakage {
  static constexpr const char* kName = "internal_leakage";
  static constexpr const char* kEquation = "Q = C (Pi - Po) from chamber i to o";
  static constexpr std::array kSites = {Site::leakage};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S conductance_m3ps_per_Pa = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"conductance_m3ps_per_Pa", "leakage past the piston", 0.0, 1e-9, 2e-12, 0.0},
        conductance_m3ps_per_Pa);
    }
  };
  struct Memory {};

  static Leak<S> leak(const Parameters& p, const S& in_Pa, const S& out_Pa) {
    const S flow_m3ps = p.conductance_m3ps_per_Pa * (in_Pa - out_Pa);
    return {flow_m3ps, -flow_m3ps};
  }

  static S conductance_m3ps_per_Pa(const Parameters& p) {
    return S(2.0) * p.conductance_m3ps_per_Pa;
  }
};

}  // namespace plant_sim::effects
