// Overlapped spool: nothing opens until the lands have passed the ports; or an amplifier that
// answers no small command.
//
//   command = u -+ a w outside, 0 inside |u| <= a w                           a > 0
//   opening = xv -+ Kv w outside, 0 inside |xv| <= Kv w                       c = 0
//   opening = (A(xv + Kv c) - A(xv - Kv c)) / (2 Kv c),  A(x) = max(|x| - Kv w, 0)^2 / 2   c > 0
//   opening = E(xv) - E(-xv),  E(x) = (x - Kv w + sqrt((x - Kv w)^2 + (Kv r)^2)) / 2        r > 0
//
// xv  spool position, m          Kv  spool position per volt, m/V          u  command, V
// w   half width of the band as a command, V; where a > 0, (1 - a) w of it is the spool's
// a   share of the band that lies ahead of the valve's lag
// c   half the range of commands over which it opens gradually, V: rounded edges and small notches,
//     as edges spread evenly over the range. Up to w a parabola joins both sides; beyond, flow
//     passes at null too.
// r   in the place of c: width over which clearance opens an edge, V, which is open by r / 2 when
//     it has just closed. Net flow alone: what both edges of a port let through is the effect
//     lap_leakage.
// Sources: overlapped four-way valve, Merritt, Hydraulic Control Systems (1967), section 5-2; E is
// the hyperbola between the asymptotes of an edge that closes on a gap.
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
      "opening = xv -+ Kv half_width outside, 0 inside, corners rounded over corner or clearance; "
      "a share ahead of it of the command";
  static constexpr std::array kSites = {Site::opening, Site::amplifier};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;
    S corner_V = 0.0;
    S clearance_V = 0.0;
    S ahead_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "overlap to either side", 0.0, 10.0, 0.05, 0.0},
        half_width_V);
      v(ParameterInfo{"corner_V",
                      "opens gradually from half_width_V less this to half_width_V plus this", 0.0,
                      10.0, 0.01, 0.0, 0.0, 1, 0, 2},
        corner_V);
      v(ParameterInfo{"clearance_V",
                      "width over which clearance of the lands opens the edges; no effect with a "
                      "corner_V",
                      0.0, 10.0, 0.01, 0.0, 0.0, 3, 1, 2},
        clearance_V);
      v(ParameterInfo{"ahead_ratio",
                      "share of the band that lies in the amplifier, ahead of the valve's lag", 0.0,
                      1.0, 0.5, 0.0, 0.0, 4, 1},
        ahead_ratio);
    }
  };
  struct Memory {};

  static S amplified_V(const Parameters& p, const S& u_V) {
    const S band_V = p.ahead_ratio * p.half_width_V;
    return u_V - clamp(u_V, -band_V, band_V);
  }

  static S opening_m(const Parameters& p, const S& x_m, const S& gain_m_per_V) {
    const S band_m = (S(1.0) - p.ahead_ratio) * p.half_width_V * gain_m_per_V;
    const S sharp_m = x_m - clamp(x_m, -band_m, band_m);
    const S corner_m = p.corner_V * gain_m_per_V;
    const S clearance_m = p.clearance_V * gain_m_per_V;
    const auto cornered = corner_m > S(0.0);
    const auto cleared = clearance_m > S(0.0);
    S opening_m = sharp_m;
    if (!all(clearance_m <= S(0.0)))
      opening_m = select(cleared, cleared_m(x_m, band_m, clearance_m), opening_m);
    if (!all(corner_m <= S(0.0)))
      opening_m = select(cornered, cornered_m(x_m, band_m, corner_m, sharp_m), opening_m);
    return opening_m;
  }

 private:
  static constexpr double kLeast = 1e-300;

  static S cornered_m(const S& x_m, const S& band_m, const S& corner_m, const S& sharp_m) {
    const S beyond_m = abs(x_m) - band_m;
    const auto rounded = abs(beyond_m) < corner_m;
    const S near_m = beyond_m + corner_m;
    const S far_m = max(corner_m - abs(x_m) - band_m, S(0.0));
    const S opening_m = (near_m * near_m - far_m * far_m) /  //
                        select(rounded, S(4.0) * corner_m, S(1.0));
    return select(rounded, select(x_m < S(0.0), -opening_m, opening_m), sharp_m);
  }

  /// E(xv) - E(-xv), rearranged so that no large terms cancel.
  static S cleared_m(const S& x_m, const S& band_m, const S& clearance_m) {
    const auto gap_m = [&](const S& overlap_m) {
      return sqrt(overlap_m * overlap_m + clearance_m * clearance_m);
    };
    const S gaps_m = gap_m(x_m - band_m) + gap_m(x_m + band_m);
    return x_m * (S(1.0) - S(2.0) * band_m / max(gaps_m, S(kLeast)));
  }
};

}  // namespace plant_sim::effects
