#include "tests/truth/shown.h"

#include <algorithm>
#include <cmath>

namespace truth {

const std::vector<Parameter>& parameters() {
  using H = Hidden;
  static const std::vector<Parameter> table{
      {"transport_delay", "delay_s", &H::delay_s, 0.02},
      {"drive_lag", "lag_s", &H::lag_s, 0.02},
      {"drive_saturation", "limit_V", &H::drive_limit_V, 0.02},
      {"null_bias", "offset_V", &H::null_bias_V, 0.02},
      {"valve_hysteresis", "half_width_V", &H::hysteresis_V, 0.02},
      {"spool_rate_limit", "rate_mps", &H::spool_rate_mps, 0.02},
      {"deadband", "half_width_V", &H::deadband_V, 0.02},
      {"deadband", "corner_V", &H::corner_V, 0.0},
      {"deadband", "clearance_V", &H::clearance_V, 0.0},
      {"deadband", "ahead_ratio", &H::ahead_ratio, 0.0},
      {"flow_asymmetry", "asymmetry_ratio", &H::asymmetry_ratio, 0.02},
      {"flow_saturation", "limit_m3ps", &H::flow_limit_m3ps, 0.02},
      {"supply_droop", "droop_Pa_per_m3ps", &H::droop_Pa_per_m3ps, 0.10},
      {"internal_leakage", "conductance_m3ps_per_Pa", &H::internal_m3ps_per_Pa, 0.10},
      {"external_leakage", "conductance_m3ps_per_Pa", &H::external_m3ps_per_Pa, 0.10},
      {"entrained_air", "fraction_ratio", &H::air_ratio, 0.02},
      {"friction", "coulomb_N", &H::coulomb_N, 0.10},
      {"friction", "static_N", &H::static_N, 0.0},
      {"friction", "stribeck_mps", &H::stribeck_mps, 0.0},
      {"friction", "presliding_stiffness_N_per_m", &H::presliding_N_per_m, 0.0},
      {"friction", "bristle_N_s_per_m", &H::bristle_N_s_per_m, 0.0},
      {"friction", "direction_ratio", &H::direction_ratio, 0.0},
      {"friction", "transition_mps", &H::transition_mps, 0.0},
      {"friction", "damping_speed_mps", &H::damping_speed_mps, 0.0},
      {"quadratic_damping", "coefficient_N_s2_per_m2", &H::quadratic_N_s2_per_m2, 0.10},
      {"load_spring", "stiffness_N_per_m", &H::spring_N_per_m, 0.02},
      {"load_spring", "rest_m", &H::rest_m, 0.02},
      {"load_force", "force_N", &H::force_N, 0.02},
      {"force_ripple", "amplitude_N", &H::ripple_N, 0.10},
      {"force_ripple", "wavelength_m", &H::ripple_wavelength_m, 0.10},
      {"force_ripple", "phase_rad", &H::ripple_phase_rad, 0.0},
      {"force_ripple", "second_sin_N", &H::ripple_second_sin_N, 0.0},
      {"force_ripple", "second_cos_N", &H::ripple_second_cos_N, 0.0},
      {"coupled_slaves", "mass_kg", &H::slaves_kg, 0.0},
      {"coupled_slaves", "damping_N_s_per_m", &H::slaves_N_s_per_m, 0.0},
      {"coupled_slaves", "needle_N_s2_per_m2", &H::needle_N_s2_per_m2, 0.10},
      {"backlash", "width_m", &H::backlash_m, 0.02},
      {"encoder_eccentricity", "amplitude_m", &H::eccentricity_m, 0.02},
      {"encoder_eccentricity", "wavelength_m", &H::eccentricity_wavelength_m, 0.02},
      {"encoder_eccentricity", "phase_rad", &H::eccentricity_phase_rad, 0.0},
  };
  return table;
}

const std::vector<std::string>& effects() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    for (const Parameter& parameter : parameters()) {
      if (found.empty() || found.back() != parameter.effect) found.push_back(parameter.effect);
    }
    return found;
  }();
  return names;
}

std::vector<std::string> hidden_effects(const Hidden& hidden) {
  const Hidden neutral;
  std::vector<std::string> found;
  std::string before;
  for (const Parameter& parameter : parameters()) {
    // An effect's first parameter is its size; the slaves may have any one of three.
    const bool size = parameter.effect != before || parameter.effect == "coupled_slaves";
    before = parameter.effect;
    if (!size || hidden.*parameter.member == neutral.*parameter.member) continue;
    if (found.empty() || found.back() != parameter.effect) found.push_back(parameter.effect);
  }
  return found;
}

namespace {

constexpr double kUneven = 0.01;  ///< asymmetry of the speeds below which there is none

bool has_place_in_servo(const std::string& effect) {
  static const std::vector<std::string> names{
      "transport_delay", "drive_saturation", "null_bias", "valve_hysteresis",
      "deadband",        "flow_asymmetry",   "backlash",  "encoder_eccentricity"};
  return std::find(names.begin(), names.end(), effect) != names.end();
}

}  // namespace

std::vector<std::string> shown_effects(const Case& of) {
  std::vector<std::string> found = hidden_effects(of.hidden);
  if (of.kind != Kind::single_rod) return found;
  found.erase(std::remove_if(found.begin(), found.end(),
                             [](const auto& effect) { return !has_place_in_servo(effect); }),
              found.end());
  if (std::abs(speed_asymmetry(of.rod, of.hidden.force_N)) > kUneven) {
    found.emplace_back("flow_asymmetry");
  }
  return found;
}

std::vector<std::string> unshown_effects(const Case& of) {
  if (of.kind != Kind::single_rod) return {};
  std::vector<std::string> found = hidden_effects(of.hidden);
  found.erase(std::remove_if(found.begin(), found.end(), has_place_in_servo), found.end());
  return found;
}

double value_of(const Parameter& parameter, const Case& of) {
  if (of.kind == Kind::single_rod && parameter.effect == "flow_asymmetry") {
    return speed_asymmetry(of.rod, of.hidden.force_N);
  }
  return of.hidden.*parameter.member;
}

Case lacking(Case of, const std::string& effect) {
  const Hidden neutral;
  for (const Parameter& parameter : parameters()) {
    if (parameter.effect == effect) of.hidden.*parameter.member = neutral.*parameter.member;
  }
  if (of.kind == Kind::single_rod && effect == "flow_asymmetry") {
    of.rod.area_rod_m2 = of.rod.area_cap_m2;
    of.hidden.force_N = 0.0;
  }
  return of;
}

}  // namespace truth
