// Air bubbles make the oil soft, the more so the lower its pressure.
//
//   x = alpha (pa/p)^(1/1.4),   beta_eff = beta (1 + x) / (1 + x beta/(1.4 p))
//
// alpha  air's share of the volume at atmospheric pressure     pa  1.01e5 Pa
// p  absolute pressure, the chamber's and pa, Pa               beta  of the oil alone, Pa
// 1.4  exponent of a change of state without exchange of heat
// Source: Merritt, Hydraulic Control Systems (1967), chapter 2; polytropic form after
// Manring and Fales, Hydraulic Control Systems (2019), chapter 2.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct EntrainedAir {
  static constexpr const char* kName = "entrained_air";
  static constexpr const char* kEquation =
      "beta_eff = beta (1 + x)/(1 + x beta/(1.4 p)), x = alpha (pa/p)^(1/1.4)";
  static constexpr std::array kSites = {Site::bulk_modulus};
  static constexpr bool kDissipative = false;

  struct Parameters {
    S fraction_ratio = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"fraction_ratio", "volume of air at atmospheric pressure per volume", 0.0,
                      0.5, 0.02, 0.0},
        fraction_ratio);
    }
  };
  struct Memory {};

  static S bulk_modulus_Pa(const Parameters& p, const S& modulus_Pa, const S& at_Pa) {
    const S absolute_Pa = max(at_Pa, S(0.0)) + S(kAtmosphere_Pa);
    const S share =
        p.fraction_ratio * exp(log(S(kAtmosphere_Pa) / absolute_Pa) * S(1.0 / kExponent));
    return modulus_Pa *
           ((S(1.0) + share) / (S(1.0) + share * modulus_Pa / (S(kExponent) * absolute_Pa)));
  }

 private:
  static constexpr double kAtmosphere_Pa = 1.01e5;
  static constexpr double kExponent = 1.4;
};

}  // namespace plant_sim::effects
