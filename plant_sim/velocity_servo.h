// A servo known only by command and position: the command sets the speed, through a lag.
//
//   y' = opening(x),   tau x' = gain u - x                            (tau = 0: x = gain u)
//                      tau^2 x'' + 2 zeta tau x' + x = gain u         where zeta > 0
//
// y  position, m     x  speed that the valve asks for, m/s     u  command, V
// gain  m/s per V    tau  time constant, s; 0 is none
// zeta  damping ratio of a lag of second order with the natural frequency 1 / tau
// The quasi-static limit of the hydraulic actuator: pressures and mass follow at once. Effects act
// on the command, on gain u (acceleration_limit), on x (deadband, flow_asymmetry, underlap: x
// stands for the spool position, gain for its travel per volt), and on the reading. Position is
// relative, and the stroke has no end. Each step with the command held is solved exactly in x; what
// opening() makes of it is integrated by Gauss's rule of two points. The effect second_order_lag
// gives a lag of first order inertia.
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
  static constexpr std::array kSites = {effects::Site::command,   effects::Site::amplifier,
                                        effects::Site::set_speed, effects::Site::lag,
                                        effects::Site::opening,   effects::Site::lap,
                                        effects::Site::sensor};

  struct Parameters {
    S gain_mps_per_V = 0.05;
    S time_constant_s = 0.0;
    S damping_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"gain_mps_per_V", "speed per command", 0.0, 100.0, 0.05, 0.05, 2.0},
        gain_mps_per_V);
      v(ParameterInfo{"time_constant_s", "lag of the speed behind the command; 0 is none", 0.0,
                      10.0, 0.01, 0.0, 2.0},
        time_constant_s);
      v(ParameterInfo{"damping_ratio",
                      "of a lag of second order, natural frequency 1 / time_constant_s; 0: first "
                      "order",
                      0.0, 100.0, 0.7, 0.0, 0.3},
        damping_ratio);
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
    S y_m, drive_mps, drive_mps2;

    template <class V>
    void visit(V&& v) {
      v("y_m", y_m);
      v("drive_mps", drive_mps);
      v("drive_mps2", drive_mps2);
    }
  };

  Parameters parameters;
  Initial initial;
  State state;
  effects::Effects<S> effects;

  void reset() {
    state = {initial.y_m, initial.drive_mps, S(0.0)};
    drive_V_ = 0.0;
    effects.reset();
    effects.start([&] { return motion(state.drive_mps, state.drive_mps); });
  }

  /// Call before step() after any parameter has changed, with the length of the step.
  void prepare(double step_s) {
    parameters.visit([](const ParameterInfo& info, S& value) {
      value = clamp(value, S(info.min), S(info.max));
    });
    effects.prepare(step_s);
    step_s_ = step_s;
    // the model's own damping ratio has priority over an effect's inertia
    const S ratio = effects.inertia_ratio();
    const auto inert = (parameters.damping_ratio <= S(0.0)) & (ratio > S(kLeastInertia));
    const S root = sqrt(max(ratio, S(kLeastInertia)));
    tau_s_ = select(inert, parameters.time_constant_s * root, parameters.time_constant_s);
    zeta_ = select(inert, S(0.5) / root, parameters.damping_ratio);
    second_order_ = !all(zeta_ <= S(0.0));
    constexpr double kNode = 0.21132486540518712;  // (1 - 1/sqrt 3) / 2
    early_ = response(kNode * step_s);
    late_ = response((1.0 - kNode) * step_s);
    whole_ = response(step_s);
  }

  /// One step with u_V held; u_V that is not a number counts as 0.
  void step(const S& u_V) {
    const S from_m = state.y_m;
    drive_V_ = limits::known_V(u_V);
    drive_V_ = effects.command_V(drive_V_, [&] { return motion(state.drive_mps); });
    const S goal_mps = effects.set_mps(parameters.gain_mps_per_V * drive_V_, state.drive_mps);
    const S gap_mps = state.drive_mps - goal_mps;
    S lag_m = gap_mps * tau_s_ * (S(1.0) - whole_.of_gap);
    S early_mps = gap_mps * early_.of_gap;
    S late_mps = gap_mps * late_.of_gap;
    S left_mps = gap_mps * whole_.of_gap;
    if (second_order_) {
      const S tau_s = tau_s_;
      const S rate_mps2 = state.drive_mps2;
      early_mps = early_mps + rate_mps2 * early_.of_rate_s;
      late_mps = late_mps + rate_mps2 * late_.of_rate_s;
      left_mps = left_mps + rate_mps2 * whole_.of_rate_s;
      const S left_mps2 = gap_mps * whole_.rate_of_gap_per_s + rate_mps2 * whole_.rate_of_rate;
      // the equation of the lag, integrated over the step
      lag_m = select(
          zeta_ > S(0.0),
          tau_s * (S(2.0) * zeta_ * (gap_mps - left_mps) + tau_s * (rate_mps2 - left_mps2)), lag_m);
      state.drive_mps2 = clamp(left_mps2, S(-kDrive_mps2), S(kDrive_mps2));
    }
    const S bent_mps = S(0.5) * (bent(goal_mps + early_mps) +  //
                                 bent(goal_mps + late_mps));
    const S travel_m = (goal_mps + bent_mps) * S(step_s_) + lag_m;
    state.y_m = clamp(from_m + travel_m, S(-limits::kPosition_m), S(limits::kPosition_m));
    state.drive_mps = clamp(goal_mps + left_mps, S(-kDrive_mps), S(kDrive_mps));
    const S v_mps = speed_mps();
    effects.accept(state.y_m - from_m, v_mps);
    effects.end_step([&] { return motion(state.drive_mps, v_mps); }, step_s_);
  }

  [[nodiscard]] S speed_mps() const { return opened(state.drive_mps); }

 private:
  static constexpr double kDrive_mps = 1e6;  ///< the largest gain at the largest command

  static constexpr double kDrive_mps2 = 1e18;
  static constexpr double kLeastInertia = 1e-10;  ///< below it a lag is of first order

  /// What a gap between x and gain u, and the rate at which it changes, leave after a time: of the
  /// gap  of_gap gap + of_rate rate,  of the rate  rate_of_gap gap + rate_of_rate rate.
  struct Response {
    S of_gap, of_rate_s, rate_of_gap_per_s, rate_of_rate;
  };

  Response response(double time_s) const {
    const S tau_s = tau_s_;
    const S first = exp(-min(S(time_s) / max(tau_s, S(1e-12)), S(700.0))) *
                    select(tau_s > S(0.0), S(1.0), S(0.0));
    const Response lag{first, S(0.0), S(0.0), S(0.0)};
    if (!second_order_) return lag;
    // roots -zeta +- w of s^2 + 2 zeta s + 1, w = sqrt(zeta^2 - 1), real or imaginary, in 1 / tau;
    // w is kept off the double root, where the error of that is its square
    constexpr double kOffDoubleRoot = 1e-5;
    constexpr double kHalfPi = 1.5707963267948966;
    constexpr double kLongest = 1e5;  // in tau: all is over
    const S zeta = zeta_;
    const S time = min(S(time_s) / max(tau_s, S(1e-12)), S(kLongest));
    const S squared = zeta * zeta - S(1.0);
    const S w = max(sqrt(abs(squared)), S(kOffDoubleRoot));
    const auto decayed = [](const S& exponent) { return exp(-min(exponent, S(700.0))); };
    const S envelope = decayed(zeta * time);
    const S slow = decayed(time / (zeta + w));
    const S fast = decayed(time * (zeta + w));
    const auto real = squared > S(0.0);
    const S sine = select(real, S(0.5) * (slow - fast), envelope * sin(w * time)) / w;
    const S cosine = select(real, S(0.5) * (slow + fast), envelope * sin(w * time + S(kHalfPi)));
    const auto second = [&](const S& value, const S& other) {
      return select(zeta > S(0.0), select(tau_s > S(0.0), value, S(0.0)), other);
    };
    return {second(cosine + zeta * sine, lag.of_gap), second(tau_s * sine, S(0.0)),
            second(-sine / max(tau_s, S(1e-12)), S(0.0)), second(cosine - zeta * sine, S(0.0))};
  }
  /// Speed behind the valve's openings; an underlapped port's is the net one of its two edges.
  S opened(const S& drive_mps) const {
    const S x =
        effects.opening_m(drive_mps, parameters.gain_mps_per_V, [&] { return motion(drive_mps); });
    if (!effects.laps()) return x;
    const S lap = effects.underlap_m(parameters.gain_mps_per_V);
    return x + clamp(x, -lap, lap);
  }
  /// Contribution of the effects to a linear valve.
  S bent(const S& drive_mps) const { return opened(drive_mps) - drive_mps; }

  formula::Motion<S> motion(const S& drive_mps, const S& v_mps) const {
    return {.u_V = drive_V_, .y_m = state.y_m, .v_mps = v_mps, .x_m = drive_mps};
  }
  /// The opening decides the speed: formulas see that of the last step.
  formula::Motion<S> motion(const S& drive_mps) const {
    return motion(drive_mps, effects.held_speed_mps());
  }

  double step_s_ = 0.0;
  S tau_s_, zeta_;             ///< the lag's, with an effect's inertia
  bool second_order_ = false;  ///< in any lane
  S drive_V_ = 0.0;            ///< held through the step
  Response early_, late_, whole_;
};

}  // namespace plant_sim
