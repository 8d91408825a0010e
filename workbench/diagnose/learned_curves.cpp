#include "workbench/diagnose/learned_curves.h"

#include <algorithm>

#include "config/signals/nan.h"
#include "config/units/quantity.h"

namespace workbench::diagnose {
namespace {

selection::ParameterValue value_of(const DiagnosisReport& outcome, const std::string& name) {
  const std::vector<selection::ParameterValue>& all = outcome.diagnosis.parameters;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  if (found != all.end()) return *found;
  // a refinement that the fit has left alone
  plant_sim::ModelFile better = outcome.diagnosis.better;
  const double* const value = better.value(name);
  return {name, value == nullptr ? config::signals::kNaN : *value, config::signals::kNaN, false};
}

}  // namespace

LawAxes axes_of(const estimator::greybox::LawCurve& curve) {
  const bool over_metres = curve.variable == "y_m" || curve.variable == "v_mps";
  LawAxes axes;
  axes.x_name = curve.variable == "v_mps" ? "velocity"
                : curve.variable == "y_m" ? "position"
                : curve.variable == "u_V" ? "command"
                : curve.variable == "x_m" ? "opening"
                                          : curve.variable;
  axes.x_unit = (over_metres ? "m" : "") + config::units::unit_of(curve.variable);
  axes.x_per = over_metres ? 1e3 : 1.0;
  axes.y_name = config::units::axis_words(config::units::parameter_words(curve.quantity));
  axes.y_unit = config::units::unit_of(curve.quantity);
  if (curve.held) {
    axes.held = "Drawn for " +
                config::units::words(config::units::quantity(
                    curve.held->variable, curve.held->value, config::signals::kNaN)) +
                " of " + curve.held->variable + ".";
  }
  return axes;
}

std::vector<LearnedLaw> learned_laws(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  std::vector<LearnedLaw> laws;
  for (const selection::Law& law : d.laws) {
    LearnedLaw one;
    one.law = &law;
    std::vector<std::string> names;
    Eigen::VectorXd errors(static_cast<Eigen::Index>(law.effect.parameters.size()));
    for (const auto& parameter : law.effect.parameters) {
      names.push_back(law.effect.name + "." + parameter.name);
      one.parameters.push_back(value_of(outcome, names.back()));
      errors[static_cast<Eigen::Index>(names.size() - 1)] = one.parameters.back().std_error;
    }
    one.curve = greybox::law_curve(d.better, data, law.effect.name, law.variables.front(), errors,
                                   greybox::covariance_of(data, d.final, names, errors));
    laws.push_back(std::move(one));
  }
  return laws;
}

}  // namespace workbench::diagnose
