// Screening of one further effect before it is fitted.
//
// The effect is simulated in several sizes side by side; the result is the error that remains when
// its size and all other parameters adjust linearly:
//   min |r - J a - d b|^2 / s^2 + prior(a)         d = (r(size) - r(0)) / size
// The screening ranks the effects and gives the start of each fit.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// Refinements included from the start; later ones are tried once the effect has settled.
inline constexpr int kFirstRefinements = 2;

/// Stage of the search: effects added so far, all parameters fitted.
struct ModelStage {
  std::vector<std::string> added;  ///< in order
  FitSummary fitted;
};

/// The stage's theta with the model file's values for the plant and its present effects.
[[nodiscard]] Eigen::VectorXd with_file_values(const SearchContext& context,
                                               const ModelStage& stage);

struct ScreeningResult {
  std::string effect;
  /// Root of the cost expected with the effect, squares and priors, over the stage's: that of the
  /// errors where no parameter is strained; 1 = no gain.
  double expected_ratio = 1.0;
  /// The stage's parameters, then the effect's, at starting points, most promising first. A second
  /// mass frees others where the sensor is behind its spring.
  std::vector<ParameterSubset> starts;
};

/// Screens each effect, most promising first, from the stage's parameters and from the model
/// file's: a single start misses effects that the parameters of the stage imitate. `looked` is
/// called after each effect, from any thread; may be empty.
[[nodiscard]] std::vector<ScreeningResult> screen(
    const SearchContext& context, const ModelStage& stage,
    const std::vector<plant_sim::EffectInfo>& effects,
    const std::function<void(const std::string&)>& on_screened = {});

/// The stage's parameters, then those of a periodic effect at that wavelength, its size and phase
/// by their linear estimate; empty where it cannot be simulated.
[[nodiscard]] ParameterSubset start_of_wave(const SearchContext& context, const ModelStage& stage,
                                            const plant_sim::EffectInfo& effect,
                                            double wavelength_m);

struct RefinedCandidate {
  std::string effect;
  FitSummary fitted;
};

/// Fits from every start of the screening and keeps the best by training error.
[[nodiscard]] RefinedCandidate refine(const SearchContext& context, const ScreeningResult& screened,
                                      const FitOptions& options);

}  // namespace estimator::greybox::selection
