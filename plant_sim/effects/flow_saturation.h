// An orifice passes no more than its passages let through.
//
//   |Q| <= limit      each orifice by itself
//
// Q, limit  m3/s
// Source: flow limit of servovalves, Merritt, Hydraulic Control Systems (1967), chapter 5.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct FlowSaturation {
  static constexpr const char* kName = "flow_saturation";
  static constexpr const char* kEquation = "|Q| <= limit, each orifice";
  static constexpr std::array kSites = {Site::flow};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S limit_m3ps = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"limit_m3ps", "largest flow; inf is none", 1e-9,
                      std::numeric_limits<double>::infinity(), 3e-5,
                      std::numeric_limits<double>::infinity()},
        limit_m3ps);
    }
  };
  struct Memory {};

  static S flow_m3ps(const Parameters& p, const S& flow_m3ps) {
    return clamp(flow_m3ps, -p.limit_m3ps, p.limit_m3ps);
  }
};

}  // namespace plant_sim::effects
