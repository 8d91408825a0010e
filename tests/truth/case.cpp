#include "tests/truth/case.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace truth {
namespace {

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

double number(const std::string& key, const std::string& value) {
  try {
    std::size_t used = 0;
    const double read = std::stod(value, &used);
    if (used == value.size()) return read;
  } catch (const std::exception&) {
    // said below
  }
  throw std::invalid_argument(key + ": '" + value + "' is not a number");
}

const std::vector<std::pair<std::string, double Outside::*>>& outside_fields() {
  using O = Outside;
  static const std::vector<std::pair<std::string, double O::*>> table{
      {"outside.force_N", &O::force_N},           {"outside.corner_Hz", &O::corner_Hz},
      {"outside.pulsation_Pa", &O::pulsation_Pa}, {"outside.pulsation_Hz", &O::pulsation_Hz},
      {"outside.shake_m", &O::shake_m},           {"outside.shake_Hz", &O::shake_Hz},
  };
  return table;
}

/// Sets a value by its key; false when there is no such key.
bool set_number(Case& of, const std::string& key, double value) {
  if (key == "mismatched") return of.mismatched = value != 0.0, true;
  if (key == "length_s") return of.length_s = value, true;
  if (key == "kp_V_per_m") return of.kp_V_per_m = value, true;
  if (key == "noise_m") return of.noise_m = value, true;
  if (key == "encoder_m") return of.encoder_m = value, true;
  if (key == "pressure_noise_Pa") return of.pressure_noise_Pa = value, true;
  if (key == "left_out.size") return of.left_out.size = value, true;
  if (key == "left_out.where") return of.left_out.where = value, true;
  for (const auto& [name, member] : outside_fields()) {
    if (key == name) return of.outside.*member = value, true;
  }
  for (const Parameter& parameter : parameters()) {
    if (key == parameter.effect + "." + parameter.name) {
      return of.hidden.*parameter.member = value, true;
    }
  }
  for (const PlantField& field : plant_fields()) {
    if (key == "plant." + field.name) return of.plant.*field.member = value, true;
  }
  return false;
}

/// atSECONDS:KEY; false when it is no such word.
bool set_change(Case& of, const std::string& word, double value) {
  const std::size_t colon = word.find(':');
  if (word.rfind("at", 0) != 0 || colon == std::string::npos) return false;
  Change change;
  change.at_s = number(word, word.substr(2, colon - 2));
  change.value = value;
  const std::string key = word.substr(colon + 1);
  for (const Parameter& parameter : parameters()) {
    if (key == parameter.effect + "." + parameter.name) change.hidden = parameter.member;
  }
  for (const PlantField& field : plant_fields()) {
    if (key == "plant." + field.name) change.plant = field.member;
  }
  if (change.hidden == nullptr && change.plant == nullptr) return false;
  of.changes.push_back(change);
  return true;
}

}  // namespace

const std::vector<Parameter>& parameters() {
  using H = Hidden;
  static const std::vector<Parameter> table{
      {"transport_delay", "delay_s", &H::delay_s, 0.02},
      {"null_bias", "offset_V", &H::null_bias_V, 0.02},
      {"valve_hysteresis", "half_width_V", &H::hysteresis_V, 0.02},
      {"spool_rate_limit", "rate_mps", &H::spool_rate_mps, 0.02},
      {"deadband", "half_width_V", &H::deadband_V, 0.02},
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
      {"quadratic_damping", "coefficient_N_s2_per_m2", &H::quadratic_N_s2_per_m2, 0.10},
      {"load_spring", "stiffness_N_per_m", &H::spring_N_per_m, 0.02},
      {"load_spring", "rest_m", &H::rest_m, 0.02},
      {"load_force", "force_N", &H::force_N, 0.02},
      {"force_ripple", "amplitude_N", &H::ripple_N, 0.10},
      {"force_ripple", "wavelength_m", &H::ripple_wavelength_m, 0.10},
      {"force_ripple", "phase_rad", &H::ripple_phase_rad, 0.0},
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

Hidden without(Hidden hidden, const std::string& effect) {
  const Hidden neutral;
  for (const Parameter& parameter : parameters()) {
    if (parameter.effect == effect) hidden.*parameter.member = neutral.*parameter.member;
  }
  return hidden;
}

const std::vector<PlantField>& plant_fields() {
  using P = Plant;
  static const std::vector<PlantField> table{
      {"mass_kg", &P::mass_kg},
      {"damping_N_s_per_m", &P::damping_N_s_per_m},
      {"bulk_modulus_Pa", &P::bulk_modulus_Pa},
      {"dead_volume_m3", &P::dead_volume_m3},
      {"supply_pressure_Pa", &P::supply_pressure_Pa},
      {"valve_gain_m_per_V", &P::valve_gain_m_per_V},
      {"valve_natural_frequency_rad_per_s", &P::valve_natural_frequency_rad_per_s},
      {"valve_damping_ratio", &P::valve_damping_ratio},
  };
  return table;
}

Plant draw_plant(std::size_t seed, bool mismatched) {
  Random random(seed * 2654435761U + 97);
  Plant plant;
  plant.valve_gain_m_per_V *= 1.0 + random.uniform(-0.03, 0.03);
  plant.damping_N_s_per_m *= 1.0 + random.uniform(-0.08, 0.08);
  plant.bulk_modulus_Pa *= 1.0 + random.uniform(-0.08, 0.08);
  if (mismatched) {
    plant.valve_natural_frequency_rad_per_s *= 1.0 + random.uniform(-0.12, 0.12);
    plant.valve_damping_ratio *= 1.0 + random.uniform(-0.12, 0.12);
    plant.mass_kg *= 1.0 + random.uniform(-0.08, 0.08);
    plant.dead_volume_m3 *= 1.0 + random.uniform(-0.20, 0.20);
    plant.supply_pressure_Pa *= 1.0 + random.uniform(-0.05, 0.05);
  }
  return plant;
}

Case parse_case(const std::string& text, std::size_t seed) {
  Case of;
  of.seed = seed;
  of.mismatched = text.find("mismatched=1") != std::string::npos;
  of.plant = draw_plant(seed, of.mismatched);
  std::string words = text;
  std::replace(words.begin(), words.end(), ',', ' ');
  std::replace(words.begin(), words.end(), ';', ' ');
  std::istringstream in(words);
  std::string word;
  while (in >> word) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw std::invalid_argument("'" + word + "' has no value");
    const std::string key = word.substr(0, equals);
    const std::string value = word.substr(equals + 1);
    if (key == "motion") {
      const auto& known = motions();
      if (std::find(known.begin(), known.end(), value) == known.end()) {
        throw std::invalid_argument("no motion '" + value + "'");
      }
      of.motion = value;
    } else if (key == "plant" && value == "printed") {
      of.plant = Plant{};
    } else if (key == "left_out") {
      const LeftOutInfo* info = find_left_out(value);
      if (info == nullptr) throw std::invalid_argument("no left-out effect '" + value + "'");
      of.left_out = {info->kind, info->typical, 0.5 * (info->where_low + info->where_high)};
    } else if (!set_change(of, key, number(key, value)) &&
               !set_number(of, key, number(key, value))) {
      throw std::invalid_argument("no key '" + key + "'; see the head of tests/truth/case.h");
    }
  }
  return of;
}

std::string to_text(const Case& of) {
  const Case neutral;
  std::string text = "motion=" + of.motion;
  const auto add = [&](const std::string& key, double value) {
    text += "," + key + "=" + digits(value);
  };
  if (of.mismatched) add("mismatched", 1.0);
  if (of.length_s != neutral.length_s) add("length_s", of.length_s);
  if (of.kp_V_per_m != neutral.kp_V_per_m) add("kp_V_per_m", of.kp_V_per_m);
  if (of.noise_m != neutral.noise_m) add("noise_m", of.noise_m);
  if (of.encoder_m != neutral.encoder_m) add("encoder_m", of.encoder_m);
  if (of.pressure_noise_Pa >= 0.0) add("pressure_noise_Pa", of.pressure_noise_Pa);
  for (const Parameter& parameter : parameters()) {
    const double value = of.hidden.*parameter.member;
    if (value != neutral.hidden.*parameter.member) {
      add(parameter.effect + "." + parameter.name, value);
    }
  }
  if (const LeftOutInfo* info = find_left_out(of.left_out.kind)) {
    text += ",left_out=" + info->name;
    add("left_out.size", of.left_out.size);
    add("left_out.where", of.left_out.where);
  }
  for (const auto& [name, member] : outside_fields()) {
    if (of.outside.any()) add(name, of.outside.*member);
  }
  for (const PlantField& field : plant_fields()) add("plant." + field.name, of.plant.*field.member);
  for (const Change& change : of.changes) {
    const std::string at = "at" + digits(change.at_s) + ":";
    for (const PlantField& field : plant_fields()) {
      if (change.plant == field.member) add(at + "plant." + field.name, change.value);
    }
    for (const Parameter& parameter : parameters()) {
      if (change.hidden == parameter.member) {
        add(at + parameter.effect + "." + parameter.name, change.value);
      }
    }
  }
  return text;
}

}  // namespace truth
