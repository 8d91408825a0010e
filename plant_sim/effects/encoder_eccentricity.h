// A rotary encoder (or its wheel) off centre: the reading swings once per turn.
//
//   reading = y + a sin(2 pi y/wavelength + phase)
//
// a  m     y  rod position, m     wavelength  way per turn, m; 0 is none     phase  rad
// Source: geometry of a circular scale whose centre is not its axis; a is the offset of the two on
// a wheel that rolls along the stroke.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct EncoderEccentricity {
  static constexpr const char* kName = "encoder_eccentricity";
  static constexpr const char* kEquation = "reading = y + a sin(2 pi y/wavelength + phase)";
  static constexpr std::array kSites = {Site::sensor};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S amplitude_m = 0.0;
    S wavelength_m = 0.0;
    S phase_rad = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"amplitude_m", "largest error", 0.0, 0.01, 5e-5, 0.0}, amplitude_m);
      v(ParameterInfo{"wavelength_m", "way per turn; 0 is none", 0.0, 10.0, 0.02, 0.0},
        wavelength_m);
      v(ParameterInfo{"phase_rad", "phase at y = 0", -6.3, 6.3, 1.0, 0.0}, phase_rad);
    }
  };
  struct Memory {};

  static S reading_m(const Parameters& p, const Memory& /*memory*/, const S& y_m) {
    const S wave_rad = S(kTwoPi) * y_m / max(p.wavelength_m, S(kLeast_m)) + p.phase_rad;
    return y_m + select(p.wavelength_m > S(0.0), p.amplitude_m * sin(wave_rad), S(0.0));
  }

 private:
  static constexpr double kTwoPi = 6.283185307179586;
  static constexpr double kLeast_m = 1e-6;
};

}  // namespace plant_sim::effects
