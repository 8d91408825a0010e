#include "estimator/greybox/pressure_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/units/quantity.h"
#include "estimator/greybox/held_scale.h"
#include "plant_sim/formula/formula.h"

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
  if (!model.changes.empty()) return true;
  const auto given = [](const plant_sim::NamedValue& one) {
    return one.name.starts_with("pressure_") && std::isfinite(one.value);
  };
  const auto cushion = [](const plant_sim::NamedValue& one) {
    return one.name.find("cushion_length_m") != std::string::npos && one.value > 0.0;
  };
  return std::any_of(model.initial.begin(), model.initial.end(), given) ||
         std::any_of(model.parameters.begin(), model.parameters.end(), cushion);
}

/// True for a return pressure that no gauge has told: it is small, and known to some tenths of a
/// bar at best, so that held it may not set the scale of all pressures.
bool is_rough(const plant_sim::ModelFile& model, const std::string& name) {
  if (name != "return_pressure_Pa") return false;
  return std::none_of(model.priors.begin(), model.priors.end(),
                      [&](const auto& prior) { return prior.name == name && prior.value == 0.0; });
}

/// True when a parameter that scales is not among the fitted ones.
bool ties(const FitSummary& fitted, const std::string& name, double value) {
  if (value == 0.0 || power_of(name) == 0.0) return false;
  return std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                      [&](const FreeParameter& p) { return p.name == name; });
}

/// Power of the scale with which a formula's result must change; none for a formula that sees a
/// spool, whose travel is not known to scale, or has a memory.
std::optional<double> power_of(const plant_sim::formula::FormulaView& formula) {
  const auto* const first = formula.program.reads;
  const auto* const last = first + formula.program.read_count;
  if (formula.remembers || std::find(first, last, plant_sim::formula::kSpool) != last) return {};
  return formula.place.site == plant_sim::effects::Site::force ? 1.0 : 0.0;
}

constexpr double kScale = 1.7;  ///< tried on formulas
constexpr int kStates = 96;     ///< at which a formula is tried
constexpr double kExact = 1e-9;

/// True for a formula whose law stays the same when pressures and its parameters scale, at states
/// all over its signals' ranges.
bool scales(const plant_sim::formula::FormulaView& formula, const std::vector<double>& values) {
  const std::optional<double> power = power_of(formula);
  if (!power) return false;
  std::vector<double> scaled = values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    scaled[i] *=
        std::pow(kScale, power_of(std::string(formula.name) + "." + formula.parameters[i].name));
  }
  plant_sim::formula::ExpressionEvaluator<double> before(formula.program);
  plant_sim::formula::ExpressionEvaluator<double> after(formula.program);
  before.set_parameters(values.data());
  after.set_parameters(scaled.data());
  bool acts = false;
  for (int k = 1; k <= kStates; ++k) {
    std::array<double, plant_sim::formula::kSignals> at{};
    for (std::size_t i = 0; i < at.size(); ++i) {
      // multiples of different roots, modulo 1: no two signals go together
      const double share = std::fmod(k * std::sqrt(static_cast<double>(i) + 2.3), 1.0);
      const plant_sim::formula::VariableRange& range = formula.ranges[i];
      at[i] = range.min + share * (range.max - range.min);
    }
    at[plant_sim::formula::kSpeed] *= std::pow(10.0, -(k % 4));  // creep as well as full speed
    const double expected = std::pow(kScale, *power) * before(at.data());
    acts = acts || expected != 0.0;
    at[plant_sim::formula::kInPressure] *= kScale;
    at[plant_sim::formula::kOutPressure] *= kScale;
    if (!(std::abs(after(at.data()) - expected) <= kExact * std::abs(expected))) return false;
  }
  // one that is nowhere seen to act says nothing, unless it is absent
  return acts || std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
}

/// True where a formula that is present, or fitted, ties the parameters to an absolute scale.
bool formulas_tie(const plant_sim::ModelFile& model, const FitSummary& fitted) {
  if (model.formula_effects.empty()) return false;
  const plant_sim::formula::Formulas formulas = model.formulas();
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    const plant_sim::formula::FormulaView& formula = formulas.data()[k];
    const auto own = std::find_if(model.effects.begin(), model.effects.end(),
                                  [&](const auto& one) { return one.name == formula.name; });
    if (own == model.effects.end()) return true;
    bool acts = own->present;
    std::vector<double> values;
    for (const plant_sim::NamedValue& one : own->parameters) {
      values.push_back(one.value);
      for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
        const FreeParameter& p = fitted.parameters[i];
        if (p.name != own->name + "." + one.name) continue;
        values.back() = p.to_physical(fitted.theta[static_cast<Index>(i)]);
        acts = true;
      }
    }
    if (acts && !scales(formula, values)) return true;
  }
  return false;
}

}  // namespace

double pressure_scale_power(const std::string& name) { return power_of(name); }

VectorXd pressure_scale(const plant_sim::ModelFile& model, const FitSummary& fitted) {
  const auto is_supply = [](const auto& one) { return one.name == "supply_pressure_Pa"; };
  if (std::none_of(model.parameters.begin(), model.parameters.end(), is_supply)) return {};
  if (has_absolute(model) || formulas_tie(model, fitted)) return {};
  for (const plant_sim::NamedValue& one : model.parameters) {
    if (!is_rough(model, one.name) && ties(fitted, one.name, one.value)) return {};
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
