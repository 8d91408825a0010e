#include "plant_sim/parameter.h"

#include <utility>

namespace plant_sim {

std::string unit_of(std::string_view name) {
  // longest first: the first that ends the name is its unit
  static constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"_m3ps_per_Pa", "m3/s/Pa"},
      {"_Pa_per_m3ps", "Pa/(m3/s)"},
      {"_N_s2_per_m2", "N s2/m2"},
      {"_N_s_per_m", "N s/m"},
      {"_mps_per_V", "m/s/V"},
      {"_kg_per_m3", "kg/m3"},
      {"_rad_per_s", "rad/s"},
      {"_N_per_m", "N/m"},
      {"_N_per_V", "N/V"},
      {"_V_per_m", "V/m"},
      {"_m_per_V", "m/V"},
      {"_m3ps", "m3/s"},
      {"_mps", "m/s"},
      {"_rad", "rad"},
      {"_m2", "m2"},
      {"_m3", "m3"},
      {"_Pa", "Pa"},
      {"_kg", "kg"},
      {"_N", "N"},
      {"_V", "V"},
      {"_m", "m"},
      {"_s", "s"}};
  for (const auto& [suffix, unit] : kUnits) {
    if (name.ends_with(suffix)) return std::string(unit);
  }
  return "";
}

}  // namespace plant_sim
