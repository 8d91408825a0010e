// The valve's null is not where the command is 0 V: amplifier offset, spool off centre.
//
//   u_out = u + offset
//
// offset  V, positive extends
// Source: null shift, Merritt, Hydraulic Control Systems (1967), chapter 7.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"

namespace plant_sim::effects {

template <class S>
struct NullBias {
  static constexpr const char* kName = "null_bias";
  static constexpr const char* kEquation = "u_out = u + offset";
  static constexpr std::array kSites = {Site::command};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S offset_V = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"offset_V", "command that the valve adds", -10.0, 10.0, 0.05, 0.0}, offset_V);
    }
  };
  struct Memory {};

  static S command_V(const Parameters& p, Memory& /*memory*/, const S& u_V) {
    return u_V + p.offset_V;
  }
};

}  // namespace plant_sim::effects
