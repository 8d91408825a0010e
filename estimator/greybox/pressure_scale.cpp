#include "estimator/greybox/pressure_scale.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "config/units/quantity.h"
#include "estimator/greybox/held_scale.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Flows per root of a pressure, or openings that stand for them.
constexpr std::array<std::string_view, 6> kOpenings{
    "valve_gain_m_per_V",           "rated_flow_m3ps",
    "retracted_cushion_orifice_m2", "extended_cushion_orifice_m2",
    "retracted_cushion_flow_m3ps",  "extended_cushion_flow_m3ps"};
/// Parameters of effects whose laws have a pressure of their own, or are not known to scale.
constexpr std::array<std::string_view, 2> kAbsolute{"entrained_air.", "change."};

/// Power of the scale with which a parameter changes.
double power_of(const std::string& name) {
  const std::string word = name.substr(name.rfind('.') + 1);
  const std::string unit = config::units::unit_of(name);
  if (is_force(name) || word == "droop_Pa_per_m3ps") return 1.0;
  if (unit == "Pa" && word != "rated_drop_Pa") return 1.0;
  if (word == "conductance_m3ps_per_Pa") return -1.0;
  if (std::find(kOpenings.begin(), kOpenings.end(), word) != kOpenings.end()) return -0.5;
  // travel of the spool stands for an opening where the valve's gain does
  if (word == "rate_mps") return -0.5;
  return 0.0;
}

bool is_absolute(const std::string& name) {
  return std::any_of(kAbsolute.begin(), kAbsolute.end(),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

/// True when a parameter that scales is not among the fitted ones.
bool ties(plant_sim::ModelFile& model, const FitSummary& fitted, const std::string& name) {
  const double* value = model.value(name);
  if (value == nullptr || *value == 0.0 || power_of(name) == 0.0) return false;
  return std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                      [&](const FreeParameter& p) { return p.name == name; });
}

}  // namespace

VectorXd pressure_scale(const plant_sim::ModelFile& file, const FitSummary& fitted) {
  plant_sim::ModelFile model = file;
  if (model.value("supply_pressure_Pa") == nullptr || !model.formula_effects.empty()) return {};
  std::vector<std::string> names{"return_pressure_Pa"};
  for (const FreeParameter& p : plant_parameters(model)) names.push_back(p.name);
  for (const FreeParameter& p : present_parameters(model)) names.push_back(p.name);
  for (const std::string& name : names) {
    if (is_absolute(name) || ties(model, fitted, name)) return {};
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
