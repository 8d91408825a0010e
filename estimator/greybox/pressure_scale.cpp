#include "estimator/greybox/pressure_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "config/units/quantity.h"
#include "estimator/greybox/held_scale.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Flows per root of a pressure, or openings that stand for them.
constexpr std::array<std::string_view, 2> kOpenings{"valve_gain_m_per_V", "rated_flow_m3ps"};
/// Effects and tables whose laws have a pressure or a flow of their own, or differ between plants.
constexpr std::array<std::string_view, 3> kAbsolute{"entrained_air.", "spool_rate_limit.",
                                                    "change."};

/// Power of the scale with which a parameter changes.
double power_of(const std::string& name) {
  const std::string word = name.substr(name.rfind('.') + 1);
  if (is_force(name) || word == "droop_Pa_per_m3ps") return 1.0;
  if (config::units::unit_of(name) == "Pa" && word != "rated_drop_Pa") return 1.0;
  if (word == "conductance_m3ps_per_Pa") return -1.0;
  return std::find(kOpenings.begin(), kOpenings.end(), word) != kOpenings.end() ? -0.5 : 0.0;
}

/// True for a parameter whose law is not known to scale, or that one record has for itself.
bool is_absolute(const std::string& name) {
  return name.find(kInRecord) != std::string::npos ||
         std::any_of(kAbsolute.begin(), kAbsolute.end(),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

/// True where the model has something that an absolute pressure or flow belongs to.
bool has_absolute(const plant_sim::ModelFile& model) {
  if (!model.formula_effects.empty() || !model.changes.empty()) return true;
  const auto given = [](const plant_sim::NamedValue& one) {
    return one.name.starts_with("pressure_") && std::isfinite(one.value);
  };
  const auto cushion = [](const plant_sim::NamedValue& one) {
    return one.name.find("cushion_length_m") != std::string::npos && one.value > 0.0;
  };
  return std::any_of(model.initial.begin(), model.initial.end(), given) ||
         std::any_of(model.parameters.begin(), model.parameters.end(), cushion);
}

/// True when a parameter that scales is not among the fitted ones.
bool ties(const FitSummary& fitted, const std::string& name, double value) {
  if (value == 0.0 || power_of(name) == 0.0) return false;
  return std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                      [&](const FreeParameter& p) { return p.name == name; });
}

}  // namespace

VectorXd pressure_scale(const plant_sim::ModelFile& model, const FitSummary& fitted) {
  const auto is_supply = [](const auto& one) { return one.name == "supply_pressure_Pa"; };
  if (std::none_of(model.parameters.begin(), model.parameters.end(), is_supply)) return {};
  if (has_absolute(model)) return {};
  for (const plant_sim::NamedValue& one : model.parameters) {
    if (ties(fitted, one.name, one.value)) return {};
  }
  for (const plant_sim::ModelFile::Effect& effect : model.effects) {
    for (const plant_sim::NamedValue& one : effect.parameters) {
      const std::string name = effect.name + "." + one.name;
      if (effect.present && (is_absolute(name) || ties(fitted, name, one.value))) return {};
    }
  }
  VectorXd along = VectorXd::Zero(fitted.theta.size());
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (is_absolute(p.name)) return {};
    const double power = power_of(p.name);
    if (power == 0.0) continue;
    const auto at = static_cast<Index>(i);
    const double value = p.to_physical(fitted.theta[at]);
    if (value == 0.0) continue;
    if (fitted.at_bound[i] != 0) return {};
    along[at] = power * value / p.slope(fitted.theta[at]);
  }
  return along;
}

void clear_pressure_scale(const plant_sim::ModelFile& model, FitSummary& fitted) {
  if (fitted.jacobian.size() == 0) return;
  const VectorXd along = pressure_scale(model, fitted);
  if (along.size() == 0 || !along.allFinite() || along.isZero()) return;
  const VectorXd seen = fitted.jacobian * along;
  fitted.jacobian -= seen * along.transpose() / along.squaredNorm();
}

}  // namespace estimator::greybox
