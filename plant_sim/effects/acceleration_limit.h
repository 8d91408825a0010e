// A drive with a loop of its own ramps the speed that it is asked for.
//
//   |w'| <= limit      w follows the commanded speed, ahead of the servo's lag
//
// w  speed that the loop is given, m/s    limit  m/s^2
// w starts at the speed from which the servo starts; a step has the mean of w over it. Source:
// ramp generator of a speed-controlled drive, Leonhard, Control of Electrical Drives, chapter 7.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct AccelerationLimit {
  static constexpr const char* kName = "acceleration_limit";
  static constexpr const char* kEquation = "|w'| <= limit, w follows the commanded speed";
  static constexpr std::array kSites = {Site::set_speed};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S limit_mps2 = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"limit_mps2", "steepest ramp of the commanded speed; inf is none", 1e-6,
                      std::numeric_limits<double>::infinity(), 0.5,
                      std::numeric_limits<double>::infinity()},
        limit_mps2);
    }
  };
  struct Memory {
    S held_mps = 0.0;
    double step_s = 1.0;
    bool begun = false;

    void prepare(double of_s) { step_s = of_s; }
    void reset() { begun = false; }
  };

  static S set_mps(const Parameters& p, Memory& memory, const S& asked_mps, const S& moving_mps) {
    if (!memory.begun) memory.held_mps = moving_mps;
    memory.begun = true;
    const S before_mps = memory.held_mps;
    const S most_mps = p.limit_mps2 * S(memory.step_s);
    memory.held_mps = clamp(asked_mps, before_mps - most_mps, before_mps + most_mps);
    const S way_mps = memory.held_mps - before_mps;
    const S ramp_share = abs(way_mps) / most_mps;  // share of the step in which the speed changes
    return memory.held_mps - S(0.5) * ramp_share * way_mps;
  }
};

}  // namespace plant_sim::effects
