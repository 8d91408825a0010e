#include "workbench/diagnose/effect_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace workbench::diagnose {
namespace {

/// Standard error over the value above which a number but an effect's first stays in the table.
constexpr double kMostError = 0.5;

/// ": 34.02 +- 0.03 Hz, damping 3.0 +- 0.1 %: a second mass behind a spring (...)".
std::string second_mass_words(const selection::Diagnosis& diagnosis) {
  using config::units::quantity;
  using config::units::words;
  const auto value = [&](const std::string& name) -> const selection::ParameterValue* {
    const auto same = [&](const auto& p) { return p.name == "second_mass." + name; };
    const auto& all = diagnosis.parameters;
    const auto found = std::find_if(all.begin(), all.end(), same);
    return found == all.end() ? nullptr : &*found;
  };
  const auto* resonance = value("resonance_Hz");
  const auto* damping = value("damping_ratio");
  const auto* share = value("mass_ratio");
  const auto* sensor = value("sensor_ratio");
  if (resonance == nullptr || damping == nullptr) return "";
  const auto shown = [](const selection::ParameterValue& p) {
    return words(quantity(p.name, p.value, p.std_error)) + (p.at_bound ? " (at its bound)" : "");
  };
  std::string text =
      ": " + shown(*resonance) + ", damping " + shown(*damping) + ": a second mass behind a spring";
  if (sensor != nullptr && sensor->value > 0.0) text += " that the sensor is on";
  if (share != nullptr && share->value > 0.0) {
    const double held_Hz = resonance->value * std::sqrt(1.0 - share->value);
    text += " (" + shown(*share) + " of the moving mass; " +
            words(quantity(resonance->name, held_Hz, std::nan(""))) + " with the driven part held)";
  }
  return text;
}

/// " (natural frequency 21.2 Hz, damping ratio 0.8)"; empty for a model without such a lag.
std::string second_order_words(const selection::Diagnosis& diagnosis) {
  plant_sim::ModelFile model = diagnosis.better;
  const double* ratio = model.value("second_order_lag.inertia_ratio");
  const double* tau_s = model.value("time_constant_s");
  if (ratio == nullptr || tau_s == nullptr || !(*ratio > 0.0) || !(*tau_s > 0.0)) return "";
  const double root = std::sqrt(*ratio);
  return fmt::format(" (natural frequency {} Hz, damping ratio {})",
                     config::units::three_digits(1.0 / (2.0 * std::numbers::pi * *tau_s * root)),
                     config::units::three_digits(0.5 / root));
}

/// ": 14 values from -7200 to 4697"; empty for what is no curve.
std::string curve_words(const selection::Diagnosis& diagnosis, const std::string& effect) {
  const bool is_curve = std::any_of(
      diagnosis.laws.begin(), diagnosis.laws.end(),
      [&](const selection::Law& law) { return law.effect.name == effect && law.effect.curve; });
  std::vector<double> values;
  for (const selection::ParameterValue& p : diagnosis.parameters) {
    if (is_curve && p.name.rfind(effect + ".", 0) == 0) values.push_back(p.value);
  }
  if (values.empty()) return "";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format(": {} values from {} to {}", values.size(),
                     config::units::three_digits(*least), config::units::three_digits(*most));
}

}  // namespace

std::string name_words(const selection::Diagnosis& diagnosis, const std::string& effect) {
  return effect + (diagnosis.is_in_file(effect) ? " beyond the model's own" : "");
}

std::string names_words(const selection::Diagnosis& diagnosis,
                        const std::vector<std::string>& effects) {
  std::vector<std::string> names;
  names.reserve(effects.size());
  for (const std::string& effect : effects) names.push_back(name_words(diagnosis, effect));
  return config::schema::listed(names);
}

std::string effect_words(const selection::Diagnosis& diagnosis, const std::string& effect) {
  if (effect == "second_mass") return effect + second_mass_words(diagnosis);
  const std::string curve = curve_words(diagnosis, effect);
  if (!curve.empty()) return effect + curve;
  std::string text;
  for (const selection::ParameterValue& p : diagnosis.parameters) {
    if (p.in_model || p.name.rfind(effect + ".", 0) != 0) continue;
    // a value without an error is one that the record does not show, or stands at its bound
    const bool unseen = std::isnan(p.std_error) && !p.at_bound;
    if (!text.empty() && (unseen || p.std_error > kMostError * std::abs(p.value))) continue;
    text += (text.empty() ? ": " : ", ") + config::units::parameter_words(p.name) + " " +
            config::units::words(config::units::quantity(p.name, p.value, p.std_error)) +
            (p.at_bound ? " (at its bound)" : "");
  }
  if (effect == "second_order_lag") text += second_order_words(diagnosis);
  return name_words(diagnosis, effect) + text;
}

std::string effects_words(const selection::Diagnosis& diagnosis,
                          const std::vector<std::string>& effects) {
  const auto text = [&](const std::string& effect) { return effect_words(diagnosis, effect); };
  return config::schema::joined_by(effects, text, "; ");
}

}  // namespace workbench::diagnose
