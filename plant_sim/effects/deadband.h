// Overlapped spool: nothing opens until the lands have passed the ports.
//
//   opening = xv -+ Kv w outside, 0 inside |xv| <= Kv w                       c = 0
//   opening = +-(d + Kv c)^2 / (4 Kv c),  d = |xv| - Kv w, where |d| < Kv c   c > 0
//
// xv  spool position, m          Kv  spool position per volt, m/V
// w   half width of the band as a command, V
// c   half width of the rounded corner as a command, V, up to w: rounded edges, the clearance of
//     the lands and small notches let a valve open gradually. A parabola joins both sides smoothly.
// Source: overlapped four-way valve, Merritt, Hydraulic Control Systems (1967), section 5-2; the
// corner is the quadratic spline through the two lines.
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
      "opening = xv -+ Kv half_width outside, 0 inside, with a rounded corner";
  static constexpr std::array kSites = {Site::opening};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;
    S corner_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "overlap to either side", 0.0, 10.0, 0.05, 0.0},
        half_width_V);
      v(ParameterInfo{"corner_V", "opens gradually within it, to either side of the half width",
                      0.0, 10.0, 0.01, 0.0, 0.0, 1},
        corner_V);
    }
  };
  struct Memory {};

  static S opening_m(const Parameters& p, const S& x_m, const S& gain_m_per_V) {
    const S band_m = p.half_width_V * gain_m_per_V;
    const S sharp_m = x_m - clamp(x_m, -band_m, band_m);
    if (all(p.corner_V <= S(0.0))) return sharp_m;
    const S corner_m = min(p.corner_V, p.half_width_V) * gain_m_per_V;
    const S beyond_m = abs(x_m) - band_m;
    const auto rounded = abs(beyond_m) < corner_m;
    const S root_m = beyond_m + corner_m;
    const S opening_m = root_m * root_m / select(rounded, S(4.0) * corner_m, S(1.0));
    return select(rounded, select(x_m < S(0.0), -opening_m, opening_m), sharp_m);
  }
};

}  // namespace plant_sim::effects
