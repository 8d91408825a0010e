// A mass that the command pushes: a linear motor, or a motor and screw, with a fast current loop.
//
//   y' = v,   M v' = gain u - d v - F
//
// y v  position and speed, m and m/s     M  moving mass, kg     u  command, V
// gain  force per volt, N/V      d  viscous damping, N/(m/s)      F  what effects resist with
// There is no end of the stroke: position is relative.
// Source: inertia and friction model of a prismatic joint, Janot, Gautier, Brunot, Data set and
// reference models of EMPS (2019).
#pragma once

#include <array>

#include "plant_sim/coupled_step.h"
#include "plant_sim/effects/table.h"
#include "plant_sim/guard.h"
#include "plant_sim/parameter.h"
#include "plant_sim/rigid_contact.h"
#include "plant_sim/runge_kutta.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

template <class S>
class ForceDrivenAxis {
 public:
  static constexpr const char* kName = "force_driven_axis";
  static constexpr std::array kSites = {effects::Site::command, effects::Site::amplifier,
                                        effects::Site::drive,   effects::Site::inertia,
                                        effects::Site::force,   effects::Site::dry_friction,
                                        effects::Site::sensor,  effects::Site::coupling};

  struct Parameters {
    S mass_kg = 100.0;
    S damping_N_s_per_m = 200.0;
    S gain_N_per_V = 35.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"mass_kg", "moving mass M", 1e-6, 1e6, 100.0, 100.0, 1.0}, mass_kg);
      v(ParameterInfo{"damping_N_s_per_m", "viscous damping d", 0.0, 1e8, 200.0, 200.0, 1.0},
        damping_N_s_per_m);
      v(ParameterInfo{"gain_N_per_V", "force per command", 0.0, 1e6, 35.0, 35.0}, gain_N_per_V);
    }
  };

  struct Initial {
    S y_m = 0.0;
    S v_mps = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"y_m", "position", -100.0, 100.0, 0.0, 0.0}, y_m);
      v(ParameterInfo{"v_mps", "speed", -100.0, 100.0, 0.0, 0.0}, v_mps);
    }
  };

  struct State {
    S y_m, v_mps;

    State moved(const State& rate, const S& by) const {
      return {y_m + by * rate.y_m, v_mps + by * rate.v_mps};
    }
    friend State operator+(const State& a, const State& b) { return a.moved(b, S(1.0)); }

    template <class V>
    void visit(V&& v) {
      v("y_m", y_m);
      v("v_mps", v_mps);
    }
  };

  Parameters parameters;
  Initial initial;
  State state;
  effects::Effects<S> effects;
  S disturbance_N = 0.0;                 ///< force against extension from outside of the model
  S disturbance_place = kPlaceOfSensor;  ///< as disturbed_parts()

  void reset() {
    state = {initial.y_m, initial.v_mps};
    effects.reset();
    effects.start([&] { return motion(state, S(0.0)); });
  }

  /// Call before step() after any parameter has changed, with the length of the step.
  void prepare(double step_s) {
    parameters.visit([](const ParameterInfo& info, S& value) {
      value = clamp(value, S(info.min), S(info.max));
    });
    effects.prepare(step_s);
    step_s_ = step_s;
    const S mass_kg = parameters.mass_kg + effects.added_mass_kg();
    const S driven_kg = mass_kg * (S(1.0) - effects.coupled_ratio());
    disturbed_ = disturbed_parts(effects, mass_kg, disturbance_place);
    driven_kg_ = driven_kg;
    inverse_mass_ = S(1.0) / driven_kg;
    most_arrest_kg_per_s_ = most_arrest_kg_per_s(driven_kg, step_s);
    contact_ = effects.contact_levels(most_arrest_kg_per_s_);
    rubs_ = !all(contact_.braking_N + contact_.gradual_N + contact_.spring_N_per_m <= S(0.0));
    constexpr double kFiner = limits::kRateStep / limits::kResonanceStep;
    spring_rate_ = max(sqrt(effects.stiffness_N_per_m(S(0.0)) * inverse_mass_),
                       S(kFiner) * effects.coupling_rate_per_s());
  }

  /// One step with u_V held; u_V that is not a number counts as 0.
  void step(const S& u_V) {
    const S known_V = limits::known_V(u_V);
    if (effects.friction_varies()) {
      effects.weigh_friction([&] { return motion(state, known_V); });
      contact_ = effects.contact_levels(most_arrest_kg_per_s_);
    }
    const S drive_V =
        effects.drive_V(effects.command_V(known_V, [&] { return motion(state, known_V); }));
    const S parts = divisions(drive_V);
    arrest_kg_per_s_ = driven_kg_ * S(1.0 / step_s_) * parts;
    const S part_s = S(step_s_) / parts;
    const int most = static_cast<int>(reduce_max(parts));
    for (int i = 0; i < most; ++i) {
      integrate(drive_V, select(S(static_cast<double>(i)) < parts, part_s, S(0.0)));
    }
    effects.end_step([&] { return motion(state, drive_V); }, step_s_);
  }

  [[nodiscard]] S speed_mps() const { return state.v_mps; }

 private:
  static formula::Motion<S> motion(const State& x, const S& u_V) {
    return {.u_V = u_V, .y_m = x.y_m, .v_mps = x.v_mps};
  }

  /// Number of parts of a step, fine enough for damping, friction and springs.
  S divisions(const S& drive_V) const {
    const S& v_mps = state.v_mps;
    S free_N = parameters.gain_N_per_V * drive_V - disturbed_.driven * disturbance_N;
    if (rubs_) {
      free_N -= parameters.damping_N_s_per_m * v_mps +
                effects.resisting_N(state.y_m, v_mps, [&] { return motion(state, drive_V); });
    }
    const S step_per_kg = S(step_s_) * inverse_mass_;
    const S least_mps = least_speed_mps(v_mps, free_N, contact_, step_per_kg);
    const S slope = parameters.damping_N_s_per_m +
                    effects.slope_N_s_per_m(v_mps, least_mps, most_arrest_kg_per_s_);
    S fastest = max(slope * inverse_mass_, spring_rate_);
    if (effects.stiffness_varies()) {
      const S stiffness = effects.stiffness_N_per_m(v_mps);
      fastest = max(fastest, sqrt(stiffness * inverse_mass_));
    }
    const S parts =
        clamp(ceil(fastest * S(step_s_ / limits::kRateStep)), S(1.0), S(limits::kMostDivisions));
    if (!rubs_) return parts;
    const auto turns = turns_within(v_mps, free_N, contact_, step_per_kg);
    const S turned = effects.turn_parts({v_mps, free_N, inverse_mass_, S(step_s_)});
    return max(parts, max(turned, select(turns, S(kTurnDivisions), S(1.0))));
  }

  void integrate(const S& drive_V, const S& step_s) {
    const S from_m = state.y_m;
    const S drive_N = parameters.gain_N_per_V * drive_V;
    const S disturbed_N = disturbed_.driven * disturbance_N;
    const auto rate = [&](const State& x, const S& further_N) -> State {
      const S free_N = drive_N - parameters.damping_N_s_per_m * x.v_mps + further_N - disturbed_N;
      const S force_N =
          effects.net_force_N(x.y_m, {x.v_mps, x.y_m - from_m, free_N, arrest_kg_per_s_},
                              [&] { return motion(x, drive_V); });
      return {x.v_mps, force_N * inverse_mass_};
    };
    if (effects.coupled()) {
      state = coupled_step(
          effects, state, step_s, disturbed_.second_per_kg * disturbance_N,
          [&](const State& x, const S& pull_mps2) { return rate(x, driven_kg_ * pull_mps2); });
    } else {
      state = runge_kutta_step(state, step_s, [&](const State& x) { return rate(x, S(0.0)); });
    }
    state.y_m = clamp(state.y_m, S(-limits::kPosition_m), S(limits::kPosition_m));
    state.v_mps = clamp(state.v_mps, S(-limits::kAxisSpeed_mps), S(limits::kAxisSpeed_mps));
    effects.accept(state.y_m - from_m, state.v_mps);
  }

  double step_s_ = 0.0;
  bool rubs_ = false;
  effects::ContactLevels<S> contact_;
  S driven_kg_, inverse_mass_, spring_rate_, most_arrest_kg_per_s_;
  DisturbedParts<S> disturbed_;
  S arrest_kg_per_s_;  ///< DryContact::arrest_kg_per_s of the present step
};

}  // namespace plant_sim
