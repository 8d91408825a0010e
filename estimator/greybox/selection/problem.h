// Structure selection: the problem of which physical effects a model lacks, judged by records.
//
// DiagnosisProblem is the question, DiagnosisOptions the procedure; every step of the search works
// on both as a SearchContext.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// State of a running search, for a progress line.
struct SearchProgress {
  int round = 0;
  bool by_innovations = false;  ///< the rig is disturbed: rounds count from one again
  bool screening = false;       ///< false: `effect` is being fitted
  std::string effect;
  int done = 0;  ///< steps of this round
  int of = 0;
  std::string best;  ///< leading effect so far; may be empty
  double best_rms_m = 0.0;
  std::vector<std::string> expected;  ///< ranking by screening, once known
};

/// Sizes that the screening tries an effect at.
inline constexpr Eigen::Index kTrialSizes = 8;

struct DiagnosisProblem {
  plant_sim::ModelFile model;
  FitDataset data;
  /// Offered by the plant and absent so far; of effects that the model has, what it lacks of them.
  std::vector<plant_sim::EffectInfo> candidate_effects;
  /// Of the candidates, those whose size a record shows only where it changes.
  std::vector<std::string> shown_by_change = {};
  bool effects_only = false;                    ///< neither laws nor changes are sought
  std::vector<FreeParameter> plant_parameters;  ///< plant and present effects
  Eigen::Index trial_sizes = kTrialSizes;       ///< fewer where they fit the rig
  double interpolated_nats = 0.0;  ///< gain of interpolating the command, which is not exact
};

struct SearchContext;

/// True when some motion would separate explanations that describe the record about equally well;
/// `names` has one name per explanation. Such a group makes the verdict undetermined.
using Separable =
    std::function<bool(const SearchContext&, const std::vector<FitSummary>& explanations,
                       const std::vector<std::string>& names)>;

struct DiagnosisOptions {
  unsigned threads = 2;
  std::function<void(const SearchProgress&)> progress;  ///< serialised calls; may be empty
  std::function<bool()> cancel;                         ///< called from any thread; may be empty
  Separable separable;                                  ///< empty: no motion separates anything
};

class ScreeningMemo;
class SettledMemo;

struct SearchContext {
  DiagnosisProblem problem;
  DiagnosisOptions options;
  // shared by copies of the context; null: none
  std::shared_ptr<SettledMemo> memo = {};
  std::shared_ptr<ScreeningMemo> screenings = {};

  [[nodiscard]] bool cancelled() const { return options.cancel && options.cancel(); }
};

/// True where the model gives any parameter of the effect a value.
[[nodiscard]] bool has_effect(const plant_sim::ModelFile& model,
                              const plant_sim::EffectInfo& effect);

/// Effects offered by the plant that are absent from the model, or neutral in it.
[[nodiscard]] std::vector<plant_sim::EffectInfo> absent_effects(const plant_sim::ModelFile& model);

/// Makes the first refinement the effect's own size where no search would start with any.
void give_size(plant_sim::EffectInfo& refinements);

[[nodiscard]] std::vector<std::string> names_of(const std::vector<plant_sim::EffectInfo>& effects);

/// Refinements that effects of the model lack, as an effect of the same name that has nothing else.
[[nodiscard]] std::vector<plant_sim::EffectInfo> lacking_refinements(
    const plant_sim::ModelFile& model);

[[nodiscard]] DiagnosisProblem make_problem(plant_sim::ModelFile model, FitDataset data);

}  // namespace estimator::greybox::selection
