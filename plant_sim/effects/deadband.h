// Overlapped spool: nothing opens until the lands have passed the ports.
//
//   opening = xv -+ Kv w outside, 0 inside |xv| <= Kv w                       c = 0
//   opening = (A(xv + Kv c) - A(xv - Kv c)) / (2 Kv c),  A(x) = max(|x| - Kv w, 0)^2 / 2   c > 0
//
// xv  spool position, m          Kv  spool position per volt, m/V
// w   half width of the band as a command, V
// c   half the range of commands over which it opens gradually, V: rounded edges, the clearance of
//     the lands and small notches, as edges spread evenly over the range. Up to w a parabola joins
//     both sides; beyond, flow passes at null too.
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
  static constexpr const char* kEquation =
      "opening = xv -+ Kv half_width outside, 0 inside, corners rounded over corner";
  static constexpr std::array kSites = {Site::opening};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;
    S corner_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "overlap to either side", 0.0, 10.0, 0.05, 0.0},
        half_width_V);
      v(ParameterInfo{"corner_V",
                      "opens gradually from half_width_V less this to half_width_V plus this", 0.0,
                      10.0, 0.01, 0.0, 0.0, 1, 0, 2},
        corner_V);
    }
  };
  struct Memory {};

  static S opening_m(const Parameters& p, const S& x_m, const S& gain_m_per_V) {
    const S band_m = p.half_width_V * gain_m_per_V;
    const S sharp_m = x_m - clamp(x_m, -band_m, band_m);
    if (all(p.corner_V <= S(0.0))) return sharp_m;
    const S corner_m = p.corner_V * gain_m_per_V;
    const S beyond_m = abs(x_m) - band_m;
    const auto rounded = abs(beyond_m) < corner_m;
    const S near_m = beyond_m + corner_m;
    const S far_m = max(corner_m - abs(x_m) - band_m, S(0.0));
    const S opening_m = (near_m * near_m - far_m * far_m) /  //
                        select(rounded, S(4.0) * corner_m, S(1.0));
    return select(rounded, select(x_m < S(0.0), -opening_m, opening_m), sharp_m);
  }
};

}  // namespace plant_sim::effects
