// Play between command and spool: the spool follows only after the command has turned by 2 w.
//
//   u_out(k) = min(max(u_out(k-1), u(k) - w), u(k) + w)
//
// w  half width of the loop, V     k  integration step; it starts from u_out = 0
// Source: play operator, Krasnosel'skii and Pokrovskii, Systems with Hysteresis (1989).
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct ValveHysteresis {
  static constexpr const char* kName = "valve_hysteresis";
  static constexpr const char* kEquation = "u_out = previous u_out, kept within u -+ half_width";
  static constexpr std::array kSites = {Site::command};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S half_width_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"half_width_V", "half width of the loop", 0.0, 10.0, 0.05, 0.0},
        half_width_V);
    }
  };
  struct Memory {
    S out_V = 0.0;
  };

  static S command_V(const Parameters& p, Memory& memory, const S& u_V) {
    memory.out_V = clamp(memory.out_V, u_V - p.half_width_V, u_V + p.half_width_V);
    return memory.out_V;
  }
};

}  // namespace plant_sim::effects
