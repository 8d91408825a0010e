// The power unit's pressure falls with what is drawn from it, without delay.
//
//   Ps_eff = Ps - D Q,   Q = g sqrt(Ps_eff - P)
//   so Q^2 + g^2 D Q - g^2 (Ps - P) = 0,   Q = 2 g (Ps - P) / (g D + sqrt((g D)^2 + 4 (Ps - P)))
//
// Ps  supply pressure without flow, Pa      P  pressure behind the open orifice, Pa
// D   droop, Pa/(m3/s)      g  flow of the orifice per sqrt(Pa)      Q  flow drawn, m3/s
// Backwards (P > Ps) the same with both signs turned. Under 1 bar of drop the plant's orifice is
// no square root any more; Q there is still the square root's.
// Source: source resistance of a power unit, Merritt, Hydraulic Control Systems (1967), chapter 11.
#pragma once

#include <array>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct SupplyDroop {
  static constexpr const char* kName = "supply_droop";
  static constexpr const char* kEquation = "Ps_eff = Ps - droop Q, Q^2 = g^2 (Ps_eff - P)";
  static constexpr std::array kSites = {Site::supply};
  static constexpr bool kDissipative = true;

  struct Parameters {
    S droop_Pa_per_m3ps = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"droop_Pa_per_m3ps", "fall of the supply pressure per flow", 0.0, 1e13, 1e10,
                      0.0},
        droop_Pa_per_m3ps);
    }
  };
  struct Memory {};

  static S supply_Pa(const Parameters& p, const S& supply_Pa, const S& port_Pa, const S& flow) {
    const S drop_Pa = supply_Pa - port_Pa;
    const S resisting = flow * p.droop_Pa_per_m3ps;
    const S below = resisting + sqrt(resisting * resisting + S(4.0) * abs(drop_Pa));
    const S drawn_m3ps = S(2.0) * flow * drop_Pa / max(below, S(kLeast));
    return supply_Pa - p.droop_Pa_per_m3ps * drawn_m3ps;
  }

 private:
  static constexpr double kLeast = 1e-150;  ///< without drop and flow nothing is drawn
};

}  // namespace plant_sim::effects
