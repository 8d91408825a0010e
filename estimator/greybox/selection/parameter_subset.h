// Fits of a subset of a model's parameters.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

struct ParameterSubset {
  std::vector<FreeParameter> parameters;
  Eigen::VectorXd start;
};

/// "friction" of "friction.coulomb_N".
[[nodiscard]] inline std::string effect_of(const FreeParameter& parameter) {
  return parameter.name.substr(0, parameter.name.find('.'));
}
/// True for a parameter of an effect that was added to the model.
[[nodiscard]] inline bool belongs_to(const FreeParameter& parameter, const std::string& effect) {
  return !parameter.in_model && parameter.name.rfind(effect + ".", 0) == 0;
}

/// Parameters with keep(parameter), starting at their present values.
template <class Keep>
[[nodiscard]] ParameterSubset subset(const FitSummary& fitted, const Keep& keep) {
  ParameterSubset result;
  std::vector<double> values;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (!keep(fitted.parameters[i])) continue;
    result.parameters.push_back(fitted.parameters[i]);
    values.push_back(fitted.theta[static_cast<Eigen::Index>(i)]);
  }
  result.start =
      Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return result;
}

/// True when one of the first `count` parameters, those of the plant, ended at a bound.
[[nodiscard]] bool ends_at_bound(const FitSummary& fitted, std::size_t count);

/// True when an effect's size, among the parameters from `first` on, is at the bound of what it can
/// be: it then stands for something else. Phases and sizes of 0 do not count, a resonance
/// without damping does: there is none.
[[nodiscard]] bool leaves_its_range(const FitSummary& fitted, std::size_t first);
/// The same of the parameters from `first` to before `last`.
[[nodiscard]] bool leaves_its_range(const FitSummary& fitted, std::size_t first, std::size_t last);

/// Brings the phases of the library's periodic effects within half a turn of zero, where their
/// range allows it: a fit may end a turn away. Phases with a prior stay.
void wrap_phases(FitSummary& fitted);

void append(ParameterSubset& to, const ParameterSubset& more);
/// Takes the parameters that another fit knows at its values, and a share of the others.
void take_values(const FitSummary& known, FitSummary& fitted, double share_of_others = 1.0);

/// Fit to convergence on the samples with `weights` 1. `width` is the default within in_parallel.
[[nodiscard]] FitSummary refit(const SearchContext& context, const ParameterSubset& selection,
                               const Eigen::VectorXd& weights, SimulationWidth width = {},
                               double observer_per_s = kObserver_per_s);
/// Fit on the training samples; stopped early when after a few iterations its error is several
/// times `than_m`, or decreases too slowly to reach it.
[[nodiscard]] FitSummary refit_if_hopeful(const SearchContext& context,
                                          const ParameterSubset& selection, double than_m,
                                          SimulationWidth width = {});
/// Fit of a stage to convergence, on all threads of the options.
[[nodiscard]] FitSummary refit_to_convergence(const SearchContext& context,
                                              const FitSummary& fitted);
/// True when the effect's size, its first parameter, is zero. What is sought as a refinement alone
/// has no size.
[[nodiscard]] bool is_idle(const FitSummary& fitted, const std::string& effect);
/// Removes refinements of added effects that change nothing: at their neutral value, or without
/// influence.
void drop_idle_refinements(const std::vector<std::string>& added, FitSummary& fitted);
/// Removes effects of which no parameter is left: refinements of an effect of the file that were
/// dropped one after another.
void drop_empty_effects(std::vector<std::string>& added, const FitSummary& fitted);
/// Takes a fit from a start of revived_refinements() where it is better.
void revive(const SearchContext& context, FitSummary& fitted);

}  // namespace estimator::greybox::selection
