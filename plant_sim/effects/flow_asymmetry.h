// One direction passes more than the other: unequal lands, or areas that are not quite equal.
//
//   opening = xv (1 + a) for xv > 0,   xv (1 - a) for xv < 0      at both orifices
//
// xv  spool position behind an overlap, m     a  ratio, positive: more when extending
// Source: gain asymmetry of servovalves, ISO 10770-1 (2009).
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct FlowAsymmetry {
  static constexpr const char* kName = "flow_asymmetry";
  static constexpr const char* kEquation =
      "opening = xv (1 + a) when positive, xv (1 - a) when negative";
  static constexpr std::array kSites = {Site::opening};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S asymmetry_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"asymmetry_ratio", "more when extending, less when retracting", -0.9, 0.9,
                      0.05, 0.0},
        asymmetry_ratio);
    }
  };
  struct Memory {};

  static S opening_m(const Parameters& p, const S& x_m, const S& /*gain_m_per_V*/) {
    return x_m * (S(1.0) + select(x_m < S(0.0), -p.asymmetry_ratio, p.asymmetry_ratio));
  }
};

}  // namespace plant_sim::effects
