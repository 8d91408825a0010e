// Overlapped spool: nothing opens until the lands have passed the ports.
//
//   opening = xv -+ Kv w outside, 0 inside |xv| <= Kv w
//
// xv  spool position, m          Kv  spool position per volt, m/V
// w   half width of the band as a command, V
// Source: overlapped four-way valve, Merritt, Hydraulic Control Systems (1967), section 5-2.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct Deadband {
  static constexpr const char* kName = "deadband";
  static constexpr const char* kEquation = "opening = xv -+ Kv half_width outside, 0 inside";
  static constexpr std::array kSites = {Site::opening};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "overlap to either side", 0.0, 10.0, 0.05, 0.0},
        half_width_V);
    }
  };
  struct Memory {};

  static S opening_m(const Parameters& p, const S& x_m, const S& gain_m_per_V) {
    const S band_m = p.half_width_V * gain_m_per_V;
    return x_m - clamp(x_m, -band_m, band_m);
  }
};

}  // namespace plant_sim::effects
