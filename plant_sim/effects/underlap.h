// Underlapped (open-centre) spool: in the underlap zone both edges of a port are open at a time.
//
//   edge to the supply: max(xv + U, 0),   edge to the return: max(U - xv, 0),   U = Kv half_width
//   at equal drops a port's net opening is 2 xv inside |xv| < U and xv + U sign(xv) outside
//
// xv  spool position behind overlap and asymmetry, m       Kv  spool position per volt, m/V
// U   opening of every edge at null, m                     half_width  the same as a command, V
// The zone has twice the flow gain, and a leakage from supply to return that makes pressures follow
// loads: with half the supply in both chambers Kc = Cd w U / sqrt(rho Ps), against 0 without it.
// A plant without pressures (velocity_servo) has the net opening alone.
// Source: open-centre four-way valve, Merritt, Hydraulic Control Systems (1967), section 5-4.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct Underlap {
  static constexpr const char* kName = "underlap";
  static constexpr const char* kEquation =
      "edges open by max(+-xv + Kv half_width, 0): both of a port near null";
  static constexpr std::array kSites = {Site::lap};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "opening of every edge at null, as a command", 0.0, 10.0, 0.1,
                      0.0},
        half_width_V);
    }
  };
  struct Memory {};

  static S underlap_m(const Parameters& p, const S& gain_m_per_V) {
    return p.half_width_V * gain_m_per_V;
  }
};

}  // namespace plant_sim::effects
