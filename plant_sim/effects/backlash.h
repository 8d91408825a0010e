// Play between rod and position sensor.
//
//   reading(k) = min(max(reading(k-1), y(k) - width/2), y(k) + width/2)
//
// y  rod position, m     width  total play, m     k  integration step; it starts in the middle
// Source: play operator, Nordin and Gutman, Controlling mechanical systems with backlash (2002).
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct Backlash {
  static constexpr const char* kName = "backlash";
  static constexpr const char* kEquation = "reading = previous reading, kept within y -+ width/2";
  static constexpr std::array kSites = {Site::sensor};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S width_m = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"width_m", "total play of the sensor", 0.0, 0.1, 2e-4, 0.0}, width_m);
    }
  };
  struct Memory {
    S ahead_m = 0.0;  ///< reading less position
  };

  static S reading_m(const Parameters& /*p*/, const Memory& memory, const S& y_m) {
    return y_m + memory.ahead_m;
  }

  static void accept(const Parameters& p, Memory& memory, const S& travel_m, const S& /*v_mps*/) {
    const S half_m = S(0.5) * p.width_m;
    memory.ahead_m = clamp(memory.ahead_m - travel_m, -half_m, half_m);
  }
};

}  // namespace plant_sim::effects
