// The speed of a servo follows the command with inertia: a valve's spool, a loop of the drive.
//
//   ratio tau^2 x'' + tau x' + x = gain u     natural frequency 1 / (tau sqrt ratio),
//                                             damping ratio 1 / (2 sqrt ratio)
//
// tau  time constant of the servo's own lag, s: the area between a step and its response, whatever
//      the ratio      ratio  0 is a lag of first order, 1/4 critical damping, above it x overshoots
// Without effect where the servo itself has a lag of second order, or none (tau = 0). Source:
// second-order model of a servo valve, Merritt, Hydraulic Control Systems (1967), chapter 7.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct SecondOrderLag {
  static constexpr const char* kName = "second_order_lag";
  static constexpr const char* kEquation = "ratio tau^2 x'' + tau x' + x = gain u";
  static constexpr std::array kSites = {Site::lag};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S inertia_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"inertia_ratio", "1 / (4 zeta^2), zeta the damping ratio; 0: first order",
                      0.0, 25.0, 0.5, 0.0},
        inertia_ratio);
    }
  };
  struct Memory {};

  static S inertia_ratio(const Parameters& p) { return p.inertia_ratio; }
};

}  // namespace plant_sim::effects
