// Cylinder and valve of a hydraulic plant, whichever plant it is, computed from its parameters.
#pragma once

#include <optional>
#include <string>

#include "plant_sim/model_file.h"

namespace plant_sim {

struct Hydraulics {
  double area_m2;  ///< area of the chamber that extends
  double supply_pressure_Pa;
  double valve_gain_m_per_V;   ///< spool travel per command
  double orifice;              ///< flow per spool travel and root of the drop, m3/s/(m sqrt(Pa))
  std::string gain_parameter;  ///< the parameter that stands for the valve's size
};

/// None: the model's plant has no valve and no oil.
[[nodiscard]] std::optional<Hydraulics> hydraulics_of(const ModelFile& model);

}  // namespace plant_sim
