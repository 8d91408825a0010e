// States of four_way_cylinder.h, each listed once.
#pragma once

#include "plant_sim/four_way_cylinder.h"

namespace plant_sim {

template <class S, class Design>
template <class V>
void FourWayCylinder<S, Design>::Initial::visit(V&& v) {
  const double unset = std::numeric_limits<double>::quiet_NaN();
  const auto field = [&](const char* name, const char* what, double least, double most,
                         double usual, S& value) {
    v(ParameterInfo{name, what, least, most, usual, usual}, value);
  };
  constexpr const char* kIn = Design::kEqualSides ? "chamber that extends; unset: half supply"
                                                  : "cap-side chamber; unset: at rest";
  constexpr const char* kOut = Design::kEqualSides ? "chamber that retracts; unset: half supply"
                                                   : "rod-side chamber; unset: at rest";
  field("y_m", "rod position from the retracted stop", 0.0, 100.0, Design::kStart_m, y_m);
  field("v_mps", "rod speed", -100.0, 100.0, 0.0, v_mps);
  field("pressure_in_Pa", kIn, 0.0, 1e8, unset, pressure_in_Pa);
  field("pressure_out_Pa", kOut, 0.0, 1e8, unset, pressure_out_Pa);
  field("spool_m", "spool position", -1.0, 1.0, 0.0, spool_m);
  field("spool_mps", "spool speed", -1e3, 1e3, 0.0, spool_mps);
}

template <class S, class Design>
template <class V>
void FourWayCylinder<S, Design>::State::visit(V&& v) {
  v("y_m", y_m);
  v("v_mps", v_mps);
  v("pressure_in_Pa", in_Pa);
  v("pressure_out_Pa", out_Pa);
  v("spool_m", spool_m);
  v("spool_mps", spool_mps);
}

}  // namespace plant_sim
