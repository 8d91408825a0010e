// A force that repeats along the stroke: cogging of a linear motor, screw pitch, guide joints.
//
//   F = a sin(2 pi y/wavelength + phase)
//
// a  N     y  rod position, m     wavelength  m; 0 is no ripple     phase  rad
// Source: detent force, Gieras, Piech, Tomczuk, Linear Synchronous Motors (2012).
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct ForceRipple {
  static constexpr const char* kName = "force_ripple";
  static constexpr const char* kEquation = "F = a sin(2 pi y/wavelength + phase)";
  static constexpr std::array kSites = {Site::force};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S amplitude_N = 0.0;
    S wavelength_m = 0.0;
    S phase_rad = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"amplitude_N", "largest force", 0.0, 1e6, 200.0, 0.0}, amplitude_N);
      v(ParameterInfo{"wavelength_m", "period along the stroke; 0 is no ripple", 0.0, 10.0, 0.01,
                      0.0},
        wavelength_m);
      v(ParameterInfo{"phase_rad", "phase at y = 0", -6.3, 6.3, 1.0, 0.0}, phase_rad);
    }
  };
  struct Memory {};

  static S resisting_N(const Parameters& p, const S& y_m, const S& /*v_mps*/) {
    const S wave_rad = S(kTwoPi) * y_m / length_m(p) + p.phase_rad;
    return select(p.wavelength_m > S(0.0), p.amplitude_N * sin(wave_rad), S(0.0));
  }

  static S stiffness_N_per_m(const Parameters& p) {
    return select(p.wavelength_m > S(0.0), S(kTwoPi) * p.amplitude_N / length_m(p), S(0.0));
  }

 private:
  static constexpr double kTwoPi = 6.283185307179586;
  static constexpr double kLeast_m = 1e-6;
  static S length_m(const Parameters& p) { return max(p.wavelength_m, S(kLeast_m)); }
};

}  // namespace plant_sim::effects
