// A force that repeats along the stroke: cogging of a linear motor, screw pitch, guide joints.
//
//   w = 2 pi y/wavelength + phase
//   F = a sin(w) + s sin(2 w) + c cos(2 w)
//
// a, s, c  N     y  rod position, m     wavelength  m; 0 is no ripple     phase  rad
// s and c are the second harmonic: magnets and teeth are no sines.
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
  static constexpr const char* kEquation =
      "w = 2 pi y/wavelength + phase; F = a sin(w) + s sin(2 w) + c cos(2 w)";
  static constexpr std::array kSites = {Site::force};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S amplitude_N = 0.0;
    S wavelength_m = 0.0;
    S phase_rad = 0.0;
    S second_sin_N = 0.0;
    S second_cos_N = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"amplitude_N", "largest force", 0.0, 1e6, 200.0, 0.0}, amplitude_N);
      v(ParameterInfo{"wavelength_m", "period along the stroke; 0 is no ripple", 0.0, 10.0, 0.01,
                      0.0},
        wavelength_m);
      v(ParameterInfo{"phase_rad", "phase at y = 0", -6.3, 6.3, 1.0, 0.0}, phase_rad);
      v(ParameterInfo{"second_sin_N", "second harmonic, in phase", -1e6, 1e6, 50.0, 0.0, 0.0, 3},
        second_sin_N);
      v(ParameterInfo{"second_cos_N", "second harmonic, a quarter period ahead", -1e6, 1e6, 50.0,
                      0.0, 0.0, 3},
        second_cos_N);
    }
  };
  struct Memory {};

  static S resisting_N(const Parameters& p, const S& y_m, const S& /*v_mps*/) {
    const S wave_rad = S(kTwoPi) * y_m / length_m(p) + p.phase_rad;
    const S sine = sin(wave_rad);
    const S cosine = sin(wave_rad + S(0.25 * kTwoPi));
    const S second_N =
        S(2.0) * p.second_sin_N * sine * cosine + p.second_cos_N * (S(1.0) - S(2.0) * sine * sine);
    return select(p.wavelength_m > S(0.0), p.amplitude_N * sine + second_N, S(0.0));
  }

  static S stiffness_N_per_m(const Parameters& p) {
    const S most_N = p.amplitude_N + S(2.0) * (abs(p.second_sin_N) + abs(p.second_cos_N));
    return select(p.wavelength_m > S(0.0), S(kTwoPi) * most_N / length_m(p), S(0.0));
  }

 private:
  static constexpr double kTwoPi = 6.283185307179586;
  static constexpr double kLeast_m = 1e-6;
  static S length_m(const Parameters& p) { return max(p.wavelength_m, S(kLeast_m)); }
};

}  // namespace plant_sim::effects
