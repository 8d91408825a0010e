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

std::vector<std::string> case_keys() {
  std::vector<std::string> keys{"mismatched", "log_every", "log_mean"};
  for (const auto& [name, member] : case_fields()) keys.push_back(name);
  for (const auto& [name, member] : outside_fields()) keys.push_back(name);
  return keys;
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
