// A servo known only by command and position: the command sets the speed, through a lag.
//
//   y' = opening(x),   tau x' = gain u - x      (tau = 0: x = gain u)
//
// y  position, m     x  speed that the valve asks for, m/s     u  command, V
// gain  m/s per V    tau  time constant, s; 0 is none
// The quasi-static limit of the hydraulic actuator: pressures and mass follow at once. Effects act
// on the command and on x (deadband, flow_asymmetry, underlap: x stands for the spool position,
// gain for its travel per volt), and on the reading. There is no end of the stroke: position is
// relative. Each step with the command held is solved exactly in x; what opening() makes of it is
// integrated by Gauss's rule of two points.
#pragma once

#include <array>

#include "plant_sim/effects/table.h"
#include "plant_sim/guard.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

template <class S>
class VelocityServo {
 public:
  static constexpr const char* kName = "velocity_servo";
  static constexpr std::array kSites = {effects::Site::command, effects::Site::opening,
                                        effects::Site::lap, effects::Site::sensor};

  struct Parameters {
    S gain_mps_per_V = 0.05;
    S time_constant_s = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"gain_mps_per_V", "speed per command", 0.0, 100.0, 0.05, 0.05, 2.0},
        gain_mps_per_V);
      v(ParameterInfo{"time_constant_s", "lag of the speed behind the command; 0 is none", 0.0,
                      10.0, 0.01, 0.0, 0.2},
        time_constant_s);
    }
  };

  struct Initial {
    S y_m = 0.0;
    S drive_mps = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"y_m", "position", -100.0, 100.0, 0.0, 0.0}, y_m);
      v(ParameterInfo{"drive_mps", "speed that the lag starts from", -100.0, 100.0, 0.0, 0.0},
        drive_mps);
    }
  };

  struct State {
    S y_m, drive_mps;

    template <class V>
    void visit(V&& v) {
      v("y_m", y_m);
      v("drive_mps", drive_mps);
    }
  };

  Parameters parameters;
  Initial initial;
  State state;
  effects::Effects<S> effects;

  void reset() {
    state = {initial.y_m, initial.drive_mps};
    effects.reset();
  }

  /// Call before step() after any parameter has changed, with the length of the step.
  void prepare(double step_s) {
    parameters.visit([](const ParameterInfo& info, S& value) {
      value = clamp(value, S(info.min), S(info.max));
    });
    effects.prepare(step_s);
    step_s_ = step_s;
    constexpr double kNode = 0.21132486540518712;  // (1 - 1/sqrt 3) / 2
    early_ = remains(kNode * step_s);
    late_ = remains((1.0 - kNode) * step_s);
    whole_ = remains(step_s);
  }

  /// One step with u_V held; u_V that is not a number counts as 0.
  void step(const S& u_V) {
    const S from_m = state.y_m;
    const S goal_mps = parameters.gain_mps_per_V * effects.command_V(limits::known_V(u_V));
    const S gap_mps = state.drive_mps - goal_mps;
    const S lag_m = gap_mps * parameters.time_constant_s * (S(1.0) - whole_);
    const S bent_mps = S(0.5) * (bent(goal_mps + gap_mps * early_) +  //
                                 bent(goal_mps + gap_mps * late_));
    const S travel_m = (goal_mps + bent_mps) * S(step_s_) + lag_m;
    state.y_m = clamp(from_m + travel_m, S(-limits::kPosition_m), S(limits::kPosition_m));
    state.drive_mps = clamp(goal_mps + gap_mps * whole_, S(-kDrive_mps), S(kDrive_mps));
    effects.accept(state.y_m - from_m, speed_mps());
  }

  [[nodiscard]] S speed_mps() const { return opened(state.drive_mps); }

 private:
  static constexpr double kDrive_mps = 1e6;  ///< the largest gain at the largest command

  /// Part of a difference between x and gain u that is left after the time.
  S remains(double time_s) const {
    return exp(-min(S(time_s) / max(parameters.time_constant_s, S(1e-12)), S(700.0))) *
           select(parameters.time_constant_s > S(0.0), S(1.0), S(0.0));
  }
  /// Speed behind the valve's openings; an underlapped port's is the net one of its two edges.
  S opened(const S& drive_mps) const {
    const S x = effects.opening_m(drive_mps, parameters.gain_mps_per_V, state.y_m);
    if (!effects.laps()) return x;
    const S lap = effects.underlap_m(parameters.gain_mps_per_V);
    return x + clamp(x, -lap, lap);
  }
  /// Contribution of the effects to a linear valve.
  S bent(const S& drive_mps) const { return opened(drive_mps) - drive_mps; }

  double step_s_ = 0.0;
  S early_, late_, whole_;
};

}  // namespace plant_sim
