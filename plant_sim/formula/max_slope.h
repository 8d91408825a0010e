// Upper bound on the slope of a formula, from differences; determines the plants' step length. The
// bound errs to the large side; only features narrower than the distance of the sample points are
// missed.
#pragma once

#include <array>
#include <cstddef>

#include "plant_sim/formula/formula.h"
#include "plant_sim/scalar.h"

namespace plant_sim::formula {

/// |f(x + near) - f(x - near)| / (2 near).
template <class S, class F>
S slope_at(F&& f, const S& x, double near) {
  return abs(f(x + S(near)) - f(x - S(near))) * S(0.5 / near);
}

/// The largest |dQ/dp| of a leakage, for either pressure within its range.
template <class S, class F>
S steepest_m3ps_per_Pa(const VariableRange& pressure_Pa, F&& leak_m3ps) {
  constexpr int kPoints = 9;
  const double way_Pa = (pressure_Pa.max - pressure_Pa.min) / (kPoints - 1);
  const double near_Pa = 1e-3 * way_Pa;
  S most = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const S in_Pa = pressure_Pa.min + way_Pa * i;
      const S out_Pa = pressure_Pa.min + way_Pa * j;
      const auto by_in = [&](const S& p) { return leak_m3ps(p, out_Pa); };
      const auto by_out = [&](const S& p) { return leak_m3ps(in_Pa, p); };
      most = max(most, slope_at(by_in, in_Pa, near_Pa));
      most = max(most, slope_at(by_out, out_Pa, near_Pa));
    }
  }
  return most;
}

/// Slope and stiffness of forces F(y, v), found once per change of parameters. Speeds are divided
/// into octaves from 0.1 mm/s to beyond the speed guard.
template <class S>
class MaxSlope {
 public:
  /// Raises the slopes to those of a further force.
  template <class F>
  void include(const VariableRange& position_m, const VariableRange& speed_mps, F&& force_N) {
    const double way_m = position_m.max - position_m.min;
    const auto stiffest = [&](double v_mps) {
      S most = 0.0;
      for (int i = 0; i < kPositions; ++i) {
        const S y_m = position_m.min + way_m * i / (kPositions - 1);
        const auto by_position = [&](const S& y) { return force_N(y, S(v_mps)); };
        most = max(most, slope_at(by_position, y_m, kNear_m * way_m));
      }
      return most;
    };
    S most = 0.0;
    S stiffness = stiffest(0.0);
    double from_mps = 0.0;
    double to_mps = kLeast_mps;
    for (std::size_t i = 0; i < kOctaves; ++i) {
      S& slope = slopes_N_s_per_m_[i];
      const double edge_mps = i + 1 < kOctaves ? to_mps : speed_mps.max;
      stiffness = max(stiffness, max(stiffest(edge_mps), stiffest(-edge_mps)));
      stiffnesses_N_per_m_[i] = max(stiffnesses_N_per_m_[i], stiffness);
      for (const double place : {0.0, 0.5, 1.0}) {
        const S y_m = position_m.min + place * way_m;
        const auto by_speed = [&](const S& v) { return force_N(y_m, v); };
        for (const double sign : {1.0, -1.0})
          most = max(most, octave(by_speed, sign * from_mps, sign * to_mps));
      }
      slope = max(slope, most);
      from_mps = to_mps;
      to_mps *= 2.0;
    }
  }

  /// The largest |dF/dv| at any speed up to |v_mps|.
  [[nodiscard]] S slope_N_s_per_m(const S& v_mps) const { return up_to(v_mps, slopes_N_s_per_m_); }

  /// The largest |dF/dy| over the range of positions, at any speed up to |v_mps|.
  [[nodiscard]] S stiffness_N_per_m(const S& v_mps) const {
    return up_to(v_mps, stiffnesses_N_per_m_);
  }
  /// The same at any speed.
  [[nodiscard]] const S& stiffness_N_per_m() const { return stiffnesses_N_per_m_.back(); }

 private:
  static constexpr int kPositions = 33;
  static constexpr double kNear_m = 1e-3;  ///< distance within the range
  static constexpr std::size_t kOctaves = 24;
  static constexpr double kLeast_mps = 1e-4;

  static S up_to(const S& v_mps, const std::array<S, kOctaves>& by_octave) {
    const S speed_mps = abs(v_mps);
    S most = by_octave[0];
    double edge_mps = kLeast_mps;
    for (std::size_t i = 1; i < kOctaves; ++i) {
      most = select(speed_mps > S(edge_mps), by_octave[i], most);
      edge_mps *= 2.0;
    }
    return most;
  }

  /// The steepest of two halves of the way and of the points between them.
  template <class F>
  static S octave(F&& force_N, double from_mps, double to_mps) {
    constexpr int kParts = 2;
    const double part_mps = (to_mps - from_mps) / kParts;
    const double size_mps = part_mps < 0.0 ? -part_mps : part_mps;
    S most = 0.0;
    S before_N = force_N(S(from_mps));
    for (int i = 1; i <= kParts; ++i) {
      const S v_mps = from_mps + part_mps * i;
      const S after_N = force_N(v_mps);
      most = max(most, abs(after_N - before_N) * S(1.0 / size_mps));
      most = max(most, slope_at(force_N, v_mps, 0.01 * size_mps));
      before_N = after_N;
    }
    return most;
  }

  std::array<S, kOctaves> slopes_N_s_per_m_{};
  std::array<S, kOctaves> stiffnesses_N_per_m_{};
};

}  // namespace plant_sim::formula
