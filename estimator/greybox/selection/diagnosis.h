// What a diagnosis says in the end, and what it rests on.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

enum class Verdict { nothing_missing, missing, undetermined, unexplained, not_excited };
/// "nothing_missing", ...
[[nodiscard]] const char* to_string(Verdict verdict);

struct ParameterValue {
  std::string name;
  double value = 0.0;      ///< SI, the unit in the name
  double std_error = 0.0;  ///< NaN where the record does not say (at a bound)
  bool at_bound = false;
};

/// Where a residual enters the equations, and which variable it goes with.
struct Localisation {
  std::string site;              ///< "flow", "force", "gain", "measurement"
  std::string variable;          ///< "y", "v", "u", "speed", "acceleration", "time", "direction"
  double explained_ratio = 0.0;  ///< of the held-out squared error
};

struct SelectionStep {
  std::string added;  ///< empty: the model as given, its parameters fitted
  double validation_rms_m = 0.0;
};

struct Diagnosis {
  Verdict verdict = Verdict::nothing_missing;
  std::vector<std::string> missing;                 ///< in the order added
  std::vector<std::vector<std::string>> ambiguous;  ///< groups of two or three names
  std::vector<std::vector<std::string>>
      same_here;  ///< one equation on this plant, whatever the motion
  double noise_floor_m = 0.0;
  double nominal_rms_m = 0.0;              ///< held-out, the model file as it is
  double rms_before_m = 0.0;               ///< held-out, its parameters fitted
  double rms_after_m = 0.0;                ///< held-out, with what is missing
  std::vector<ParameterValue> parameters;  ///< of the better model, fitted to all samples
  std::vector<Localisation> where;         ///< best first; empty when nothing is left to explain
  std::vector<SelectionStep> steps;
  std::vector<std::string> notes;  ///< restrictions: gaps, interrupted, ...
  StructureSearch search;
  FitSummary final;             ///< the better model on all samples
  plant_sim::ModelFile better;  ///< the model file with it
  double runtime_s = 0.0;
};

/// Runs the whole diagnosis. Ends early, with the best result so far and a note, once
/// `options.cancel` returns true.
[[nodiscard]] Diagnosis diagnose(const DiagnosisProblem& problem, const DiagnosisOptions& options);

}  // namespace estimator::greybox::selection
