// A drive or a valve's amplifier follows no command beyond a limit: that of its current, its speed,
// the spool's stroke.
//
//   |u_out| <= limit      behind formulas of the command, ahead of every lag
//
// u  command, V      limit  V
// Source: actuator saturation, Franklin, Powell, Emami-Naeini, Feedback Control of Dynamic Systems.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct DriveSaturation {
  static constexpr const char* kName = "drive_saturation";
  static constexpr const char* kEquation = "|u_out| <= limit";
  static constexpr std::array kSites = {Site::amplifier};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S limit_V = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"limit_V", "largest command that is followed; inf is none", 1e-6,
                      std::numeric_limits<double>::infinity(), 1.0,
                      std::numeric_limits<double>::infinity()},
        limit_V);
    }
  };
  struct Memory {};

  static S amplified_V(const Parameters& p, const S& u_V) {
    return clamp(u_V, -p.limit_V, p.limit_V);
  }
};

}  // namespace plant_sim::effects
