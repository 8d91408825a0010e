// Laminar leakage out of each chamber, past the rod seals.
//
//   Q = C P     out of each chamber
//
// C  conductance, m3/s per Pa      P  that chamber's pressure, Pa
// Source: Merritt, Hydraulic Control Systems (1967), chapter 6.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct ExternalLeakage {
  static constexpr const char* kName = "external_leakage";
  static constexpr const char* kEquation = "Q = C P out of each chamber";
  static constexpr std::array kSites = {Site::leakage};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S conductance_m3ps_per_Pa = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"conductance_m3ps_per_Pa", "leakage past each rod seal", 0.0, 1e-9, 2e-12,
                      0.0},
        conductance_m3ps_per_Pa);
    }
  };
  struct Memory {};

  static Leak<S> leak(const Parameters& p, const S& in_Pa, const S& out_Pa) {
    return {p.conductance_m3ps_per_Pa * in_Pa, p.conductance_m3ps_per_Pa * out_Pa};
  }

  static S conductance_m3ps_per_Pa(const Parameters& p) { return p.conductance_m3ps_per_Pa; }
};

}  // namespace plant_sim::effects
