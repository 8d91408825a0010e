// A drive gives no more than its current limit or its motor lets it.
//
//   |u_out| <= limit      before the drive's lag
//
// u  command, V      limit  V: the command of the largest force
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
  static constexpr std::array kSites = {Site::drive};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S limit_V = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"limit_V", "command of the largest force; inf is none", 1e-6,
                      std::numeric_limits<double>::infinity(), 1.0,
                      std::numeric_limits<double>::infinity()},
        limit_V);
    }
  };
  struct Memory {};

  static S drive_V(const Parameters& p, Memory& /*memory*/, const S& u_V) {
    return clamp(u_V, -p.limit_V, p.limit_V);
  }
};

}  // namespace plant_sim::effects
