// Leakage of the spool's laps at null: what clearance and worn edges let through an edge that is
// shut.
//
//   opening of an edge = e + Kv w                      e >= 0
//                      = Kv w / (1 + |e| / (Kv f))     e < 0
//
// e  by how much the land has opened the edge, m; negative where it covers it
// w  opening of an edge just closed, as a command, V        Kv  spool position per volt, m/V
// f  overlap that halves what is left, as a command, V; infinite: all edges leak everywhere
// Behind a deadband e is 0 throughout the band: edges that overlap count as just closed there.
// All four edges leak: oil passes from supply to return, and pressures follow loads.
// Source: Eryilmaz, Wilson, Unified modeling and analysis of a proportional valve, J. Franklin
// Institute 343 (2006) 48-68.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct LapLeakage {
  static constexpr const char* kName = "lap_leakage";
  static constexpr const char* kEquation =
      "edges open by e + Kv opening where e >= 0, Kv opening / (1 + |e| / (Kv fade)) below";
  static constexpr std::array kSites = {Site::edge};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S opening_V = 0.0;
    S fade_V = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"opening_V", "opening that an edge just closed leaks by, as a command", 0.0,
                      10.0, 0.05, 0.0},
        opening_V);
      v(ParameterInfo{"fade_V", "overlap that halves the leakage, as a command; inf is none", 1e-3,
                      std::numeric_limits<double>::infinity(), 0.3,
                      std::numeric_limits<double>::infinity(), 0.0, 1},
        fade_V);
    }
  };
  struct Memory {};

  static S edge_m(const Parameters& p, const S& ahead_m, const S& gain_m_per_V) {
    const S null_m = p.opening_V * gain_m_per_V;
    const S covered_m = max(-ahead_m, S(0.0));
    const S fade_m = max(p.fade_V * gain_m_per_V, S(kLeast));
    return max(ahead_m, S(0.0)) + null_m / (S(1.0) + covered_m / fade_m);
  }

 private:
  static constexpr double kLeast = 1e-300;
};

}  // namespace plant_sim::effects
