// A part of the moving mass sits behind a spring and a damper: a flexible coupling, an elastic
// frame, a load on a slender rod.
//
//   M = m1 + m2,   m2 = r M          m1 y'' = F + k z + c z',   m2 (y'' + z'') = -k z - c z'
//   reading = y + b z
//
// M  the plant's moving mass, all of it     r  mass_ratio: the share behind the spring
// y  position of the driven part m1         z  m2 ahead of m1, m     b  sensor_ratio
// Given are the resonance, at which the two parts swing against each other while nothing holds
// m1, and its damping, because these and r are what a record shows one by one:
//
//   w = 2 pi resonance,   k = r (1 - r) M w^2,   c = r (1 - r) M 2 damping w
//
// With m1 held, m2 swings at w sqrt(1 - r), where the drive's response has its notch; its damping
// there is damping sqrt(1 - r). r = 0, resonance = 0: M is one rigid mass. b = 0: the sensor is on
// the driven part; b = 1: on the load. The swing of the reading is (r - b)/(1 - r) F/(M w^2): where
// the drive sets the force, r and b are not seen apart, and with b = 1 nothing depends on r.
// Source: two-inertia system, Ellis, Control System Design Guide (2012), chapter 16.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct SecondMass {
  static constexpr const char* kName = "second_mass";
  static constexpr const char* kEquation =
      "m1 y'' = F + k z + c z', m2 (y'' + z'') = -k z - c z', m2 = mass_ratio M, reading = y + "
      "sensor_ratio z";
  static constexpr std::array kSites = {Site::coupling, Site::sensor};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S mass_ratio = 0.0;
    S resonance_Hz = 0.0;
    S damping_ratio = 0.0;
    S sensor_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"mass_ratio", "share of the moving mass that is behind the spring", 0.0,
                      kMostMass, 0.2, 0.0},
        mass_ratio);
      v(ParameterInfo{"resonance_Hz", "the two parts against each other; 0 is rigid", 0.0, 2000.0,
                      20.0, 0.0},
        resonance_Hz);
      v(ParameterInfo{"damping_ratio", "damping of the resonance", 0.0, 2.0, 0.05, 0.0},
        damping_ratio);
      v(ParameterInfo{"sensor_ratio", "place of the sensor: 0 driven part, 1 second mass", 0.0, 1.0,
                      1.0, 0.0, 0.0, 1},
        sensor_ratio);
    }
  };
  struct Memory {
    CouplingOffset<S> offset;

    template <class V>
    void visit(V&& v) {
      v("second_mass.offset_m", offset.offset_m);
      v("second_mass.offset_mps", offset.offset_mps);
    }
  };

  /// m2 over M.
  static S coupled_ratio(const Parameters& p) {
    return select(p.resonance_Hz > S(0.0), p.mass_ratio, S(0.0));
  }

  static S coupling_rate_per_s(const Parameters& p) { return S(kTwoPi) * p.resonance_Hz; }

  /// b; 0 for a rigid mass.
  static S sensor_place(const Parameters& p) {
    return select(p.resonance_Hz > S(0.0), p.sensor_ratio, S(0.0));
  }

  /// w^2 z + 2 damping w z'.
  static S pull_mps2(const Parameters& p, const CouplingOffset<S>& z) {
    const S rate = coupling_rate_per_s(p);
    return rate * (rate * z.offset_m + S(2.0) * p.damping_ratio * z.offset_mps);
  }

  static S reading_m(const Parameters& p, const Memory& memory, const S& y_m) {
    return y_m + sensor_place(p) * memory.offset.offset_m;
  }

 private:
  static constexpr double kTwoPi = 6.283185307179586;
  static constexpr double kMostMass = 0.95;
};

}  // namespace plant_sim::effects
