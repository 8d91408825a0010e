// The drive of an axis follows the command with a lag: a current loop, an amplifier's filter.
//
//   lag u_out' = u - u_out
//
// lag  s, time constant; before the run u_out was the first command
// The command is held over a step; the mean of u_out over the step acts, which leaves the axis with
// the speed that u_out gives it. A lag in the place of a dead time of the same length differs in
// what is fast alone. Source: first-order model of the closed current loop, Ellis, Control System
// Design Guide (2012), chapter 14.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct DriveLag {
  static constexpr const char* kName = "drive_lag";
  static constexpr const char* kEquation = "lag u_out' = u - u_out";
  static constexpr std::array kSites = {Site::drive};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S lag_s = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"lag_s", "time constant of the drive", 0.0, 0.5, 0.005, 0.0}, lag_s);
    }
  };
  struct Memory {
    S held_V = 0.0;
    double step_s = 1.0;
    bool begun = false;

    void prepare(double of_s) { step_s = of_s; }
    void reset() { begun = false; }
  };

  static S drive_V(const Parameters& p, Memory& memory, const S& u_V) {
    if (!memory.begun) memory.held_V = u_V;
    memory.begun = true;
    const S lags = S(memory.step_s) / max(p.lag_s, S(memory.step_s / kMostLags));
    const S away_V = memory.held_V - u_V;
    const S left_V = away_V * exp(S(0.0) - lags);
    memory.held_V = u_V + left_V;
    return u_V + (away_V - left_V) * p.lag_s * S(1.0 / memory.step_s);
  }

 private:
  static constexpr double kMostLags = 700.0;  ///< in one step: nothing is left
};

}  // namespace plant_sim::effects
