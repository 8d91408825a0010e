// Result of a diagnosis and the search that led to it.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/disturbance_report.h"
#include "estimator/greybox/selection/excitation.h"
#include "estimator/greybox/selection/law_dictionary.h"
#include "estimator/greybox/selection/localisation.h"
#include "estimator/greybox/selection/parameter_change.h"
#include "estimator/greybox/selection/prediction_error.h"
#include "estimator/greybox/selection/record_checks.h"
#include "estimator/greybox/selection/repeated_motion.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

enum class Verdict {
  nothing_missing,
  missing,
  undetermined,
  learned,   ///< no effect of the library explains the records, one or two laws do
  changing,  ///< no effect explains the record, one or two parameters that change within it do
  unexplained,
  not_excited
};
/// "nothing_missing", ...
[[nodiscard]] const char* to_string(Verdict verdict);

struct ParameterValue {
  std::string name;
  double value = 0.0;      ///< SI, the unit in the name
  double std_error = 0.0;  ///< NaN where the record does not determine it (at a bound)
  bool at_bound = false;
  /// Share of what is known of it that comes from the record; the rest is the file's prior. 1
  /// without a prior.
  double record_share = 1.0;
  double prior_sds = 0.0;  ///< distance from the prior's mean, in its standard deviations; signed
  bool in_model = false;   ///< FreeParameter::in_model

  /// True when most of what is known is the prior: `std_error` is then no measurement's.
  [[nodiscard]] bool held_by_prior() const { return record_share < 0.51; }
};

struct SelectionStep {
  std::string added;  ///< empty: the model as given, its parameters fitted
  double validation_rms_m = 0.0;
  /// The least of a simulation without observer; NaN where noise explains the record.
  double free_run_rms_m = std::numeric_limits<double>::quiet_NaN();
};

struct Diagnosis {
  Verdict verdict = Verdict::nothing_missing;
  std::vector<std::string> missing;  ///< in the order added, laws with them
  /// Effects that the model file has without some refinement: among `missing` it is that.
  std::vector<std::string> in_file;
  /// The laws among `missing`: learned, undetermined, or near to what an unexplained record lacks.
  std::vector<Law> laws;
  std::vector<PossibleEffect> possible;             ///< those of `missing` that are not established
  std::vector<std::vector<std::string>> ambiguous;  ///< groups of two or three names
  std::vector<std::vector<std::string>>
      same_here;  ///< groups that are equivalent on this plant for every motion
  double noise_floor_m = 0.0;
  /// No floor can be read from the records: it is the noise that the likelihood has found, or the
  /// rounding alone.
  bool floor_assumed = false;
  bool effects_only = false;               ///< as in DiagnosisProblem
  double nominal_rms_m = 0.0;              ///< held-out, the model file unchanged
  double rms_before_m = 0.0;               ///< held-out, its parameters fitted
  double rms_after_m = 0.0;                ///< held-out, better model
  std::vector<ParameterValue> parameters;  ///< better model, fitted to all samples
  std::vector<Localisation> where;         ///< best first; empty when everything is explained
  bool where_is_whole = false;             ///< `where` is of the error without the effects found
  std::vector<Localisation> whole;         ///< the same of the error without the effects found
  std::vector<SelectionStep> steps;
  /// Disturbance of the rig, where the record was judged by innovations and shows any.
  std::optional<Disturbance> disturbance;
  /// Parameters that change within the record, or between records: Verdict::changing where they
  /// explain it.
  std::vector<ParameterChange> changing;
  std::optional<RepeatedMotion>
      repetition;         ///< repetition of the final model's error, where the motion repeats
  Excitation excitation;  ///< insufficient: Verdict::not_excited
  std::optional<double> searched_s;  ///< length of the segments searched; none: all samples
  bool by_innovations = false;       ///< the likelihood of all innovations decided
  /// Where the record was judged by innovations and no physics is missing beyond what was added.
  std::optional<PredictionErrors> prediction;
  bool loses_motion = false;  ///< loses_motion() of the final model
  /// By innovations: what the absence of each effect would cost, and the gain of the best curve
  /// over a variable of the motion.
  std::map<std::string, double> gains_nats;
  double fitted_rms_m = 0.0;                    ///< fitted_rms_m() of the final model
  std::set<std::string> undriven;               ///< as InnovationSearch::undriven
  std::map<std::string, double> without_rms_m;  ///< held-out error of the model without each effect
  double curve_nats = 0.0;
  double innovations = 0.0;  ///< their number
  /// The command acts that much before the sample that it is logged with: the records were taken
  /// so (command_lead.h).
  double command_lead_samples = 0.0;
  /// Asked where the fitted model leaves many times the noise.
  std::optional<RecordChecks> checks;
  std::vector<PlantFit> plants;  ///< the same, where nothing explains the records
  StructureSearch search;
  FitSummary final;             ///< the better model on all samples
  plant_sim::ModelFile better;  ///< the model file with it
  double step_error_m = 0.0;    ///< RMS by which a shorter step changes its simulation
  double runtime_s = 0.0;

  /// True where the error of the integration step is not small beside what no model can explain.
  [[nodiscard]] bool has_coarse_step() const { return has_coarse_step_beside(floor_m()); }
  /// The same beside any error.
  [[nodiscard]] bool has_coarse_step_beside(double error_m) const {
    constexpr double kCoarse_ratio = 0.5;
    return !loses_motion && step_error_m > kCoarse_ratio * error_m;
  }
  /// True where the model file has the effect without some refinement.
  [[nodiscard]] bool is_in_file(const std::string& effect) const {
    return std::find(in_file.begin(), in_file.end(), effect) != in_file.end();
  }
  /// `missing` without `possible` and `laws`.
  [[nodiscard]] std::vector<std::string> established() const;
  /// True where the better model is more than the file's with other values.
  [[nodiscard]] bool adds_to_file() const {
    return !missing.empty() || verdict == Verdict::changing;
  }
  /// True where the answer rests on one of the names: verdicts missing and unexplained rest on what
  /// is established alone.
  [[nodiscard]] bool rests_on_one_of(const std::vector<std::string>& names) const;
  /// True where another plant without effects leaves clearly less than the better model.
  [[nodiscard]] bool fits_another_plant() const {
    return !plants.empty() && plants.front().validation_rms_m < kBetterPlant * rms_after_m;
  }
  /// The error of a simulation that sensor and disturbance cause.
  [[nodiscard]] double disturbed_floor_m() const;
  /// True where repetitions of the motion differ by more than `disturbed_floor_m()`.
  [[nodiscard]] bool repetitions_set_floor() const;
  /// The error that no model driven by the command alone can beat: that of sensor and disturbance,
  /// or the scatter between repetitions.
  [[nodiscard]] double floor_m() const;
};

/// Runs the whole diagnosis. Ends early with the best result so far once `options.cancel` returns
/// true; `search.interrupted` is then set.
[[nodiscard]] Diagnosis diagnose(const DiagnosisProblem& problem, const DiagnosisOptions& options);

}  // namespace estimator::greybox::selection
