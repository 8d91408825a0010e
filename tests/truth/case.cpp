#include "tests/truth/case.h"

#include <algorithm>
#include <cmath>
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
      {"outside.force_N", &O::force_N},
      {"outside.corner_Hz", &O::corner_Hz},
      {"outside.pulsation_Pa", &O::pulsation_Pa},
      {"outside.pulsation_Hz", &O::pulsation_Hz},
      {"outside.shake_m", &O::shake_m},
      {"outside.shake_Hz", &O::shake_Hz},
      {"outside.line_N", &O::line_N},
      {"outside.line_Hz", &O::line_Hz},
  };
  return table;
}

/// The case's own numbers, in the order in which they are written.
const std::vector<std::pair<std::string, double Case::*>>& case_fields() {
  static const std::vector<std::pair<std::string, double Case::*>> table{
      {"amplitude_ratio", &Case::amplitude_ratio},
      {"period_s", &Case::period_s},
      {"length_s", &Case::length_s},
      {"sample_s", &Case::sample_s},
      {"kp_V_per_m", &Case::kp_V_per_m},
      {"ki_V_per_m_s", &Case::ki_V_per_m_s},
      {"kd_V_s_per_m", &Case::kd_V_s_per_m},
      {"feed_V_s_per_m", &Case::feed_V_s_per_m},
      {"noise_m", &Case::noise_m},
      {"encoder_m", &Case::encoder_m},
      {"converter_V", &Case::converter_V},
      {"pressure_noise_Pa", &Case::pressure_noise_Pa},
  };
  return table;
}

/// Sets a value by its key; false when there is no such key.
bool set_number(Case& of, const std::string& key, double value) {
  if (key == "mismatched") return of.mismatched = value != 0.0, true;
  if (key == "log_every") return of.log_every = static_cast<int>(value), true;
  if (key == "log_mean") return of.log_mean = value != 0.0, true;
  for (const auto& [name, member] : case_fields()) {
    if (key == name) return of.*member = value, true;
  }
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
  for (const PlantField& field : plant_fields(of.kind)) {
    if (key == "plant." + field.name) return *field.at(of) = value, true;
  }
  return false;
}

/// atSECONDS:KEY; false when it is no such word.
bool set_change(Case& of, const std::string& word, double value) {
  const std::size_t colon = word.find(':');
  if (of.kind != Kind::actuator || word.rfind("at", 0) != 0 || colon == std::string::npos)
    return false;
  Change change;
  change.at_s = number(word, word.substr(2, colon - 2));
  change.value = value;
  const std::string key = word.substr(colon + 1);
  for (const Parameter& parameter : parameters()) {
    if (key == parameter.effect + "." + parameter.name) change.hidden = parameter.member;
  }
  for (const PlantField& field : plant_fields(Kind::actuator)) {
    if (key == "plant." + field.name) change.plant = field.member;
  }
  if (change.hidden == nullptr && change.plant == nullptr) return false;
  of.changes.push_back(change);
  return true;
}

/// The rig that a text speaks of; throws std::invalid_argument with the allowed words.
Kind kind_in(const std::string& text) {
  const std::size_t at = text.find("rig=");
  if (at == std::string::npos) return Kind::actuator;
  const std::string name = text.substr(at + 4, text.find_first_of(",; ", at) - at - 4);
  for (const Kind kind : kKinds) {
    if (to_string(kind) == name) return kind;
  }
  throw std::invalid_argument("no rig '" + name +
                              "'; there are actuator, linear_axis, rotary_axis, single_rod");
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

namespace {

constexpr double kUneven = 0.01;  ///< of speeds: an asymmetry below it is none

bool has_place_in_servo(const std::string& effect) {
  static const std::vector<std::string> names{
      "transport_delay", "null_bias", "valve_hysteresis",    "deadband",
      "flow_asymmetry",  "backlash",  "encoder_eccentricity"};
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

const std::vector<PlantField>& plant_fields(Kind kind) {
  // Of gain and supply pressure only gain * sqrt(Ps) is seen, so the gain stands for both.
  static const std::vector<PlantField> actuator{
      {"mass_kg", [](Case& c) { return &c.plant.mass_kg; }, 0.2, &Plant::mass_kg},
      {"damping_N_s_per_m", [](Case& c) { return &c.plant.damping_N_s_per_m; }, 0.6,
       &Plant::damping_N_s_per_m},
      {"bulk_modulus_Pa", [](Case& c) { return &c.plant.bulk_modulus_Pa; }, 0.4,
       &Plant::bulk_modulus_Pa},
      {"dead_volume_m3", [](Case& c) { return &c.plant.dead_volume_m3; }, 0.4,
       &Plant::dead_volume_m3},
      {"supply_pressure_Pa", [](Case& c) { return &c.plant.supply_pressure_Pa; }, 0.0,
       &Plant::supply_pressure_Pa},
      {"valve_gain_m_per_V", [](Case& c) { return &c.plant.valve_gain_m_per_V; }, 0.2,
       &Plant::valve_gain_m_per_V},
      {"valve_natural_frequency_rad_per_s",
       [](Case& c) { return &c.plant.valve_natural_frequency_rad_per_s; }, 0.2,
       &Plant::valve_natural_frequency_rad_per_s},
      {"valve_damping_ratio", [](Case& c) { return &c.plant.valve_damping_ratio; }, 0.2,
       &Plant::valve_damping_ratio},
  };
  static const std::vector<PlantField> axis{
      {"mass_kg", [](Case& c) { return &c.axis.mass_kg; }, 0.4},
      {"damping_N_s_per_m", [](Case& c) { return &c.axis.damping_N_s_per_m; }, 0.6},
      {"gain_N_per_V", [](Case& c) { return &c.axis.gain_N_per_V; }, 0.0},
  };
  static const std::vector<PlantField> rod{
      {"mass_kg", [](Case& c) { return &c.rod.mass_kg; }, 0.6},
      {"area_cap_m2", [](Case& c) { return &c.rod.area_cap_m2; }, 0.0},
      {"area_rod_m2", [](Case& c) { return &c.rod.area_rod_m2; }, 0.0},
      {"damping_N_s_per_m", [](Case& c) { return &c.rod.damping_N_s_per_m; }, 0.6},
      {"bulk_modulus_Pa", [](Case& c) { return &c.rod.bulk_modulus_Pa; }, 0.6},
      {"supply_pressure_Pa", [](Case& c) { return &c.rod.supply_pressure_Pa; }, 0.0},
      {"flow_m3ps_per_V_rootPa", [](Case& c) { return &c.rod.flow_m3ps_per_V_rootPa; }, 0.4},
      {"valve_natural_frequency_rad_per_s",
       [](Case& c) { return &c.rod.valve_natural_frequency_rad_per_s; }, 0.4},
      {"valve_damping_ratio", [](Case& c) { return &c.rod.valve_damping_ratio; }, 0.4},
  };
  switch (kind) {
    case Kind::linear_axis:
    case Kind::rotary_axis:
      return axis;
    case Kind::single_rod:
      return rod;
    case Kind::actuator:
      break;
  }
  return actuator;
}

std::string to_string(Kind kind) {
  switch (kind) {
    case Kind::linear_axis:
      return "linear_axis";
    case Kind::rotary_axis:
      return "rotary_axis";
    case Kind::single_rod:
      return "single_rod";
    case Kind::actuator:
      break;
  }
  return "actuator";
}

Case typical_case(Kind kind) {
  Case of;
  of.kind = kind;
  if (kind == Kind::linear_axis) {
    of.kp_V_per_m = 200.0;  // 8 rad/s, damped by 0.64
    of.kd_V_s_per_m = 25.0;
    of.noise_m = 1e-6;
    of.encoder_m = 1e-6;
    of.converter_V = 20.0 / 65536.0;
  } else if (kind == Kind::rotary_axis) {
    of.axis = printed_axis(true);
    of.amplitude_ratio = 20.0;  // about 0.5 rad
    of.kp_V_per_m = 6.0;        // 10 rad/s, damped by 0.66
    of.kd_V_s_per_m = 0.45;
    of.noise_m = 2e-5;
    of.encoder_m = 6.283185307e-5;  // 100 000 steps a turn
    of.converter_V = 20.0 / 65536.0;
  } else if (kind == Kind::single_rod) {
    of.amplitude_ratio = 2.0;
  }
  return of;
}

void draw_plant(Case& of) {
  Random random(of.seed * 2654435761U + 97);
  const auto off = [&](double& value, double most) { value *= 1.0 + random.uniform(-most, most); };
  if (of.kind == Kind::linear_axis || of.kind == Kind::rotary_axis) {
    off(of.axis.damping_N_s_per_m, 0.15);
    off(of.axis.mass_kg, 0.10);
    return;
  }
  if (of.kind == Kind::single_rod) {
    off(of.rod.flow_m3ps_per_V_rootPa, 0.15);
    off(of.rod.supply_pressure_Pa, 0.15);
    off(of.rod.damping_N_s_per_m, 0.15);
    off(of.rod.valve_natural_frequency_rad_per_s, 0.15);
    off(of.rod.bulk_modulus_Pa, 0.15);
    off(of.rod.mass_kg, 0.30);
    return;
  }
  off(of.plant.valve_gain_m_per_V, 0.03);
  off(of.plant.damping_N_s_per_m, 0.08);
  off(of.plant.bulk_modulus_Pa, 0.08);
  if (!of.mismatched) return;
  off(of.plant.valve_natural_frequency_rad_per_s, 0.12);
  off(of.plant.valve_damping_ratio, 0.12);
  off(of.plant.mass_kg, 0.08);
  off(of.plant.dead_volume_m3, 0.20);
  off(of.plant.supply_pressure_Pa, 0.05);
}

void draw_plant_within(Case& of, double most) {
  Random random(of.seed * 2654435761U + 101);
  for (const PlantField& field : plant_fields(of.kind)) {
    *field.at(of) *= 1.0 + random.uniform(-most, most);
  }
}

Case parse_case(const std::string& text, std::size_t seed) {
  Case of = typical_case(kind_in(text));
  of.seed = seed;
  of.mismatched = text.find("mismatched=1") != std::string::npos;
  draw_plant(of);
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
    if (key == "rig") continue;  // read first, by kind_in()
    if (key == "motion") {
      const auto& known = motions();
      if (std::find(known.begin(), known.end(), value) == known.end()) {
        throw std::invalid_argument("no motion '" + value + "'");
      }
      of.motion = value;
    } else if (key == "plant" && value == "printed") {
      const Case printed = typical_case(of.kind);
      of.plant = printed.plant;
      of.axis = printed.axis;
      of.rod = printed.rod;
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
  const Case neutral = typical_case(of.kind);
  std::string text = "motion=" + of.motion;
  if (of.kind != Kind::actuator) text = "rig=" + to_string(of.kind) + "," + text;
  const auto add = [&](const std::string& key, double value) {
    text += "," + key + "=" + digits(value);
  };
  if (of.mismatched) add("mismatched", 1.0);
  if (of.log_every != neutral.log_every) add("log_every", of.log_every);
  if (of.log_mean) add("log_mean", 1.0);
  for (const auto& [name, member] : case_fields()) {
    if (of.*member != neutral.*member) add(name, of.*member);
  }
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
    const bool line = name.rfind("outside.line", 0) == 0;
    if (line ? of.outside.line_N > 0.0 : of.outside.any()) add(name, of.outside.*member);
  }
  Case read = of;
  for (const PlantField& field : plant_fields(of.kind)) {
    add("plant." + field.name, *field.at(read));
  }
  for (const Change& change : of.changes) {
    const std::string at = "at" + digits(change.at_s) + ":";
    for (const PlantField& field : plant_fields(Kind::actuator)) {
      if (change.plant != nullptr && change.plant == field.member)
        add(at + "plant." + field.name, change.value);
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
