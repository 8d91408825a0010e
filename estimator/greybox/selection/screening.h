// One more effect tried on top of what is already in the model: a quick look first, then the fit.
//
// The quick look simulates the effect in several sizes, all side by side, and asks how far the
// error falls when its size and all other parameters may still adjust, linearly:
//   min |r - J a - d b|^2 / s^2 + prior(a)         d = (r(size) - r(0)) / size
// It ranks the effects before anything is fitted, and says where the fit should begin.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// Refinements that take part from the start; later ones are tried when the effect is settled.
inline constexpr int kFirstRefinements = 2;

/// A model as far as it has come: effects added, and all parameters fitted.
struct ModelStage {
  std::vector<std::string> added;  ///< in order
  FitSummary fitted;
};

/// The stage's search values, those of the plant and its present effects as in the model file.
[[nodiscard]] Eigen::VectorXd with_file_values(const SearchContext& context,
                                               const ModelStage& stage);

struct ScreeningResult {
  std::string effect;
  /// Expected score RMS over that of the stage: 1 = of no use.
  double expected_ratio = 1.0;
  std::vector<FreeParameter> parameters;  ///< the stage's, then the effect's
  std::vector<Eigen::VectorXd> starts;    ///< where to begin, the most promising first
};

/// A quick look at each effect, the most promising first. It looks from the stage's own parameters
/// and from the model file's: a single start misses effects that the fit of the stage has bent its
/// parameters to follow. `looked` is called after each, from any thread; it may be empty.
[[nodiscard]] std::vector<ScreeningResult> screen(
    const SearchContext& context, const ModelStage& stage,
    const std::vector<plant_sim::EffectInfo>& effects,
    const std::function<void(const std::string&)>& on_screened = {});

struct RefinedCandidate {
  std::string effect;
  FitSummary fitted;
};

/// Fits from every start of the glance and keeps the best by the fitted samples.
[[nodiscard]] RefinedCandidate refine(const SearchContext& context, const ScreeningResult& screened,
                                      const FitOptions& options);

}  // namespace estimator::greybox::selection
