// Effects that the product's library does not have: the diagnosis should say "unexplained" and
// point to the variable and the class that carry them. Equations and accepted answers stand in the
// table of left_out.cpp.
//
// Two sets of variables per effect. `variables` holds the ones in the equation. `same_signal`
// holds those that follow them so closely in a slow position loop that the record can hardly tell:
// below the hydraulic resonance v is gain * u, so u, v, speed stand for each other; a position
// dependence of a drag shows by speed as well. A score counts the first set; with the second
// added it is printed beside it.
#pragma once

#include <string>
#include <vector>

namespace truth {

struct LeftOut {
  enum class Kind {
    none,
    cubic_damping,
    stiffening_spring,
    position_damping,
    gain_drift,
    gain_curvature,
    position_leakage,
    scale_drift,
    mount_compliance,
    direction_damping,
    supply_step,
    null_drift,
    underlap,
    position_gain,
    load_step,
    power_damping,
    gain_saturation,
    one_way_saturation,
    elastic_shaft,
    open_centre,
    leaking_laps,
  };
  Kind kind = Kind::none;
  double size = 0.0;   ///< unit by kind
  double where = 0.0;  ///< s or m, where the kind has a place

  [[nodiscard]] double force_N(double y_m, double v_mps, double t_s) const;
  [[nodiscard]] double opening_m(double open_m, double gain_m_per_V, double y_m, double t_s) const;
  [[nodiscard]] double supply_factor(double t_s) const;
  [[nodiscard]] double leakage_m3ps_per_Pa(double y_m) const;
  [[nodiscard]] double command_V(double u_V, double t_s) const;
  [[nodiscard]] double reading_m(double y_m, double acceleration_mps2, double t_s) const;
};

struct LeftOutInfo {
  LeftOut::Kind kind;
  std::string name;
  std::string equation;
  double typical;
  double where_low, where_high;
  std::vector<std::string> classes;
  std::vector<std::string> variables;
  std::vector<std::string> same_signal;
};

/// Those of the actuator.
const std::vector<LeftOutInfo>& left_out_table();
/// Those of the electric axes (axis.h).
const std::vector<LeftOutInfo>& axis_left_out_table();
/// Laws that the library has by another equation, written apart from it; in no plan.
const std::vector<LeftOutInfo>& library_law_table();
/// In any table; null when there is none of that name or kind.
const LeftOutInfo* find_left_out(const std::string& name);
const LeftOutInfo* find_left_out(LeftOut::Kind kind);

}  // namespace truth
