// The pilot stage's flow bounds the spool's speed.
//
//   |xv'| <= rate,   and xv'' does not push beyond it
//
// xv  spool position, m    rate  m/s (the other valve parameters stay as they are)
// Source: pilot flow saturation, Merritt, Hydraulic Control Systems (1967), chapter 7.
#pragma once

#include <array>
#include <limits>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct SpoolRateLimit {
  static constexpr const char* kName = "spool_rate_limit";
  static constexpr const char* kEquation = "|xv'| <= rate";
  static constexpr std::array kSites = {Site::spool};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S rate_mps = std::numeric_limits<double>::infinity();

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"rate_mps", "fastest spool speed; inf is none", 1e-6,
                      std::numeric_limits<double>::infinity(), 5e-3,
                      std::numeric_limits<double>::infinity()},
        rate_mps);
    }
  };
  struct Memory {};

  static S spool_limit_mps(const Parameters& p) { return p.rate_mps; }
};

}  // namespace plant_sim::effects
