// Dry friction of seals and guides: Coulomb, Stribeck's rise towards standstill, pre-sliding.
//
//   sliding level   g(v) = (Fc + max(Fs - Fc, 0) exp(-(v/vs)^2)) (1 + r sign v)
//   rigid (k = 0)   F = g(v) sign v while it slides; at rest F holds the other forces up to g(0)
//   gradual         F = g(v) tanh(v/vt)   (without k, where vt > 0)
//   pre-sliding     F = k z + s1 exp(-(v/vd)^2) z',  dz = dx - |dx| k z / g(v)
//                   (a spring that yields at g)
//
// Fc  coulomb_N    Fs  static_N (below Fc: no rise)    vs  stribeck_mps    r  direction_ratio
// vt  transition_mps    k  presliding_stiffness_N_per_m    x  rod position
// z   bristle deflection, m
// s1  presliding_damping_N_s_per_m    with k only; 0 is Dahl's law, above it the LuGre law
// vd  damping_speed_mps    infinite in the law's first form; a finite one keeps it passive
// Rigid contact is stick and slip, not a steep curve: while the speed is so small that friction
// would stop the rod within one part of a step, F is just the force that does so, never one that
// drives. The bristle's equation is solved exactly over each travel dx, so its stiffness against
// sliding asks for no shorter step. A transition steeper than a step resolves is the rigid contact.
// All dissipate: F v >= 0,
// or k z^2 / 2 is what is stored; for that s1 z' against v, where Stribeck's level falls below k z,
// is at least -k z: the bristle's damping never drives. Sources: Karnopp (1985); Dahl (1968);
// Canudas de Wit, Olsson, Astrom, Lischinsky, A new model for control of systems with friction
// (1995); Barabanov, Ortega, Necessary and sufficient conditions for passivity of the LuGre
// friction model (2000); Armstrong-Helouvry, Dupont, Canudas de Wit (1994).
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct Friction {
  static constexpr const char* kName = "friction";
  static constexpr const char* kEquation =
      "Coulomb, Stribeck (Fc + (Fs - Fc) exp(-(v/vs)^2)) (1 + ratio sign v), pre-sliding spring or "
      "tanh(v/vt)";
  static constexpr std::array kSites = {Site::dry_friction};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S coulomb_N = 0.0;
    S static_N = 0.0;
    S stribeck_mps = 0.0;
    S presliding_stiffness_N_per_m = 0.0;
    S presliding_damping_N_s_per_m = 0.0;
    S direction_ratio = 0.0;
    S transition_mps = 0.0;
    S damping_speed_mps = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"coulomb_N", "sliding friction", 0.0, 1e6, 200.0, 0.0}, coulomb_N);
      v(ParameterInfo{"static_N", "friction at standstill; no effect below coulomb_N", 0.0, 1e6,
                      300.0, 0.0, 0.0, 1},
        static_N);
      v(ParameterInfo{"stribeck_mps", "speed over which static falls to sliding friction", 0.0,
                      10.0, 0.01, 0.0, 0.0, 1},
        stribeck_mps);
      v(ParameterInfo{"presliding_stiffness_N_per_m", "stiffness before it slides; 0 is none", 0.0,
                      1e9, 1e7, 0.0, 0.0, 2},
        presliding_stiffness_N_per_m);
      v(ParameterInfo{"presliding_damping_N_s_per_m", "damping before it slides", 0.0, 1e5, 5000.0,
                      0.0, 0.0, 2},
        presliding_damping_N_s_per_m);
      v(ParameterInfo{"direction_ratio", "more when extending, less when retracting", -1.0, 1.0,
                      0.2, 0.0, 0.0, 3},
        direction_ratio);
      v(ParameterInfo{"transition_mps",
                      "speed over which it turns its sign; no effect with a pre-sliding stiffness",
                      0.0, 10.0, 0.001, 0.0, 0.0, 4, 2},
        transition_mps);
      v(ParameterInfo{"damping_speed_mps",
                      "speed over which the pre-sliding damping fades; inf is none", 1e-6,
                      std::numeric_limits<double>::infinity(), 0.01,
                      std::numeric_limits<double>::infinity(), 0.0, 5},
        damping_speed_mps);
    }
  };
  struct Memory {
    S deflection_m = 0.0;
    S yield = 1.0;       ///< dz / dx over the last step
    S direction = 0.0;   ///< sign of that step; 0 at rest
    S rise_ratio = 1.0;  ///< Stribeck's exponential at the speed of that moment
    S v_mps = std::numeric_limits<double>::quiet_NaN();  ///< that speed

    /// Marks the cached exponential as invalid after a change of parameters.
    void prepare(double /*step_s*/) { v_mps = std::numeric_limits<double>::quiet_NaN(); }
  };

  static S friction_N(const Parameters& p, const Memory& memory, const DryContact<S>& at) {
    const bool known = all((at.v_mps <= memory.v_mps) & (at.v_mps >= memory.v_mps));
    const S rise = known ? memory.rise_ratio : rise_ratio(p, at.v_mps);
    const S forward_N = level_at_N(p, S(1.0), rise);
    const S backward_N = level_at_N(p, S(-1.0), rise);
    const S least_N = select(at.v_mps > S(0.0), S(0.0), -backward_N);
    const S most_N = select(at.v_mps < S(0.0), S(0.0), forward_N);
    const S held_N = clamp(at.drive_N + at.arrest_kg_per_s * at.v_mps, least_N, most_N);
    const S rigid_N = gradual_force_N(p, at, forward_N, backward_N, held_N);
    const auto bristled = p.presliding_stiffness_N_per_m > S(0.0);
    if (all(p.presliding_stiffness_N_per_m <= S(0.0))) return rigid_N;
    const S spring_N = p.presliding_stiffness_N_per_m * deflected_m(p, memory, at.travel_m, rise);
    const S along_N = select(at.v_mps < S(0.0), -spring_N, spring_N);
    const S level = max(select(at.v_mps < S(0.0), backward_N, forward_N), S(kLeastLevel_N));
    const S ratio = along_N / level;
    const S damped_N = damping_N_s_per_m(p, at.v_mps) * abs(at.v_mps) * (S(1.0) - ratio);
    const S total_N = along_N + max(damped_N, -along_N * min(ratio, S(1.0)));
    const S bristle_N = select(at.v_mps < S(0.0), -total_N, total_N);
    return select(bristled, bristle_N, rigid_N);
  }

  static S stiffness_N_per_m(const Parameters& p) { return p.presliding_stiffness_N_per_m; }

  static S slope_N_s_per_m(const Parameters& p, const S& least_mps, const S& most_arrest_kg_per_s) {
    const auto bristled = p.presliding_stiffness_N_per_m > S(0.0);
    const S bristle = select(bristled, p.presliding_damping_N_s_per_m, S(0.0));
    if (all(p.transition_mps <= S(0.0))) return bristle;
    const auto gradual = resolved(p, most_arrest_kg_per_s);
    const S transition_mps = select(gradual, p.transition_mps, S(1.0));
    const auto turns = abs(least_mps) < S(kTransitions) * transition_mps;
    return select(bristled, bristle,
                  select(gradual & turns, S(kFiner) * most_N(p) / transition_mps, S(0.0)));
  }

  static ContactLevels<S> levels(const Parameters& p, const S& most_arrest_kg_per_s) {
    const auto without_spring = p.presliding_stiffness_N_per_m <= S(0.0);
    const auto gradual = resolved(p, most_arrest_kg_per_s);
    const auto contact_N = [&](const S& rigid_N, const S& gradual_N) {
      return select(without_spring, select(gradual, gradual_N, rigid_N), S(0.0));
    };
    const S least_N = max(p.coulomb_N, p.static_N) * (S(1.0) - abs(p.direction_ratio));
    return {contact_N(least_N, S(0.0)), contact_N(most_N(p), S(0.0)), contact_N(S(0.0), most_N(p)),
            max(p.presliding_stiffness_N_per_m, S(0.0))};
  }

  /// Bristles bend with the way there and back, of which a step that turns sees the difference;
  /// and a step must follow Stribeck's rise.
  static S turn_parts(const Parameters& p, const Memory& memory, const TurningPart<S>& step) {
    const S& k = p.presliding_stiffness_N_per_m;
    if (all(k <= S(0.0))) return S(1.0);
    const S net_N = abs(step.free_N - k * memory.deflection_m);
    const S change_mps = net_N * step.inverse_mass_per_kg * step.step_s;
    const S least_N = max(p.coulomb_N * (S(1.0) - abs(p.direction_ratio)), S(kLeastLevel_N));
    const S lengths = change_mps * step.step_s * k / least_N;
    const S at_turn = sqrt(lengths * S(1.0 / kTurnLengths));
    const S margin_mps = S(kTurnMargin) * change_mps;
    const S turned = select(abs(step.v_mps) < margin_mps, at_turn, S(1.0));
    const S stribeck_mps = max(p.stribeck_mps, S(kLeastStribeck_mps));
    const auto on_rise = (p.static_N > p.coulomb_N) &
                         (abs(step.v_mps) < S(kStribeckReach) * stribeck_mps + margin_mps);
    const S risen = select(on_rise, change_mps / (S(kOfStribeck) * stribeck_mps), S(1.0));
    return select(k > S(0.0), clamp(ceil(max(turned, risen)), S(1.0), S(kMostTurnParts)), S(1.0));
  }

  static void accept(const Parameters& p, Memory& memory, const S& travel_m, const S& v_mps) {
    const S rise = rise_ratio(p, v_mps);
    if (!all(p.presliding_stiffness_N_per_m <= S(0.0))) {
      memory.deflection_m = deflected_m(p, memory, travel_m, rise);
    }
    memory.rise_ratio = rise;
    memory.v_mps = v_mps;
  }

  /// Sliding friction at this speed in the given direction (+1 extends, -1 retracts), >= 0.
  static S level_N(const Parameters& p, const S& direction, const S& v_mps) {
    return level_at_N(p, direction, rise_ratio(p, v_mps));
  }

 private:
  static S most_N(const Parameters& p) {
    return max(p.coulomb_N, p.static_N) * (S(1.0) + abs(p.direction_ratio));
  }

  /// The force where the transition is gradual and the step resolves it, `rigid_N` elsewhere.
  static S gradual_force_N(const Parameters& p, const DryContact<S>& at, const S& forward_N,
                           const S& backward_N, const S& rigid_N) {
    if (all(p.transition_mps <= S(0.0))) return rigid_N;
    const S level_N = select(at.v_mps < S(0.0), backward_N, forward_N);
    const auto gradual = resolved(p, at.arrest_kg_per_s);
    return select(gradual, level_N * tanh(at.v_mps / select(gradual, p.transition_mps, S(1.0))),
                  rigid_N);
  }

  /// Mask of the lanes in which friction turns its sign gradually, slowly enough for parts of a
  /// step with that `arrest_kg_per_s` (DryContact).
  static auto resolved(const Parameters& p, const S& arrest_kg_per_s) {
    return (p.transition_mps > S(0.0)) &
           (S(kResolvedRate) * p.transition_mps * arrest_kg_per_s >= most_N(p));
  }

  static constexpr double kResolvedRate = 2.0;        ///< times a part of a step: RK4 follows that
  static constexpr double kFiner = 2.0;               ///< the curve bends within a transition
  static constexpr double kTransitions = 4.0;         ///< tanh beyond has a slope under 0.2 %
  static constexpr double kLeastStribeck_mps = 1e-9;  ///< the rise then is at standstill only
  static constexpr double kTurnMargin = 2.0;          ///< changes of the speed in a step
  static constexpr double kTurnLengths = 0.002;       ///< way within a part, in lengths of yielding
  static constexpr double kStribeckReach = 3.0;       ///< the exponential beyond is 1e-4
  static constexpr double kOfStribeck = 0.1;          ///< change of the speed within a part
  static constexpr double kMostTurnParts = 16.0;
  static constexpr double kNoRise = 700.0;  ///< e^-700 is still a normal number
  static constexpr double kLeastLevel_N = 1e-9;
  static constexpr double kFewLengths = 1e-6;

  static S damping_N_s_per_m(const Parameters& p, const S& v_mps) {
    const S infinite = std::numeric_limits<double>::infinity();
    if (all(p.damping_speed_mps >= infinite)) return p.presliding_damping_N_s_per_m;
    const S ratio = v_mps / p.damping_speed_mps;
    return p.presliding_damping_N_s_per_m * decay(min(ratio * ratio, S(kNoRise)));
  }

  static S rise_ratio(const Parameters& p, const S& v_mps) {
    if (all(p.static_N <= p.coulomb_N)) return S(1.0);
    const S ratio = v_mps / max(p.stribeck_mps, S(kLeastStribeck_mps));
    return decay(min(ratio * ratio, S(kNoRise)));
  }

  static S level_at_N(const Parameters& p, const S& direction, const S& rise_ratio) {
    const S both_N = p.coulomb_N + max(p.static_N - p.coulomb_N, S(0.0)) * rise_ratio;
    return both_N * (S(1.0) + direction * p.direction_ratio);
  }

  /// The bristle after a travel of the rod, z* = +-g/k changing evenly along it:
  ///
  ///   z = z1* + (z0 - z0*) e^-h - (z1* - z0*) (1 - e^-h) / h,   h = |dx| k / g
  ///
  /// exact for an even z* and constant h / |dx|: for a step of many h as well, where z only lags.
  static S deflected_m(const Parameters& p, const Memory& memory, const S& travel_m,
                       const S& rise) {
    if (all(abs(travel_m) <= S(0.0))) return memory.deflection_m;
    const S direction = select(travel_m < S(0.0), S(-1.0), S(1.0));
    const S k = max(p.presliding_stiffness_N_per_m, S(kLeastLevel_N));
    const S from_N = max(level_at_N(p, direction, memory.rise_ratio), S(kLeastLevel_N));
    const S to_N = max(level_at_N(p, direction, rise), S(kLeastLevel_N));
    const S lengths = min(S(2.0) * abs(travel_m) * k / (from_N + to_N), S(kNoRise));
    const S remains = decay(lengths);
    const auto few = lengths < S(kFewLengths);
    const S share =
        select(few, S(1.0) - S(0.5) * lengths, (S(1.0) - remains) / select(few, S(1.0), lengths));
    const S along_m_per_N = direction / k;
    const S from_m = from_N * along_m_per_N;
    const S to_m = to_N * along_m_per_N;
    const S moved_m = to_m + (memory.deflection_m - from_m) * remains - (to_m - from_m) * share;
    return select(abs(travel_m) <= S(0.0), memory.deflection_m, moved_m);
  }
};

}  // namespace plant_sim::effects
