// A finished diagnosis with the request that it answers: the source of text, JSON, model file and
// HTML report.
#pragma once

#include <iosfwd>
#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"
#include "workbench/diagnose/request.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

struct DiagnosisReport {
  const PreparedDiagnosis* prepared = nullptr;  ///< must outlive this object
  selection::Diagnosis diagnosis;
  std::string advice;
  bool interrupted = false;
  /// Free run from each segment's first sample, all samples; NaN when nothing was fitted.
  double free_run_before_m = std::numeric_limits<double>::quiet_NaN();  ///< the file as it is
  double free_run_after_m = std::numeric_limits<double>::quiet_NaN();   ///< the better model

  /// False when the records did not move enough for anything to be fitted.
  [[nodiscard]] bool fitted() const { return diagnosis.final.theta.size() > 0; }
};

/// Measured less modelled position of the long series, under the observer or without (0).
[[nodiscard]] Eigen::VectorXd residual_of_file_m(const selection::DiagnosisProblem& problem,
                                                 double observer_per_s);
[[nodiscard]] Eigen::VectorXd residual_of_m(const selection::DiagnosisProblem& problem,
                                            const greybox::FitSummary& fitted,
                                            double observer_per_s);

/// Fills in the free-run errors.
void simulate_freely(DiagnosisReport& outcome);

/// The effects that a round's winner brought, empty when nothing was taken.
[[nodiscard]] std::vector<std::string> taken_in(const selection::StructureSearch& search,
                                                std::size_t round);
/// Whether one of these effects is left in the end: what a round takes may be dropped later.
[[nodiscard]] bool stayed(const selection::StructureSearch& search,
                          const std::vector<std::string>& effects);
/// The round that decided: the last in which something was taken that stayed, or else the last.
/// Rounds there must be.
[[nodiscard]] std::size_t deciding_round(const selection::StructureSearch& search);

// Result of a diagnosis as sentences.

/// "friction: Coulomb 145 +- 2 N, static 181 +- 4 N", with the values of the better model.
[[nodiscard]] std::string effect_words(const selection::Diagnosis& diagnosis,
                                       const std::string& effect);

/// "the rod moves by 0.01 mm in all, 0.001 mm of it noise"
[[nodiscard]] std::string excitation_words(const selection::Excitation& excitation);

/// Restrictions: gaps of the records, long records, interruption.
[[nodiscard]] std::vector<std::string> notes(const DiagnosisReport& outcome);

/// The verdict, one sentence.
[[nodiscard]] std::string verdict_words(const selection::Diagnosis& diagnosis);

/// One paragraph each: fall of the error, rivals, site of the remaining error, advice.
[[nodiscard]] std::vector<std::string> remarks(const DiagnosisReport& outcome);

/// Command that follows; empty where there is none.
[[nodiscard]] std::string next_command(const DiagnosisReport& outcome);

/// "every other 2 s is fitted, the rest scores", ...
[[nodiscard]] std::string split_words(const DiagnosisReport& outcome);

/// "model file as it is", "+ friction", ...
struct StepWords {
  std::string what;
  double rms_m = 0.0;
};
[[nodiscard]] std::vector<StepWords> step_words(const selection::Diagnosis& diagnosis);

/// Without its folder.
[[nodiscard]] std::string file_name(const std::string& file);

/// Whether a parameter belongs to an effect that was found missing.
[[nodiscard]] bool was_added(const selection::Diagnosis& diagnosis, const std::string& parameter);

/// "as a force that goes with the speed".
[[nodiscard]] std::string where_words(const selection::Localisation& where);

/// A diagnosis as text for a terminal: words first, then the figures.
void print(const DiagnosisReport& outcome, std::ostream& out);

/// A diagnosis as JSON, SI throughout; missing numbers are null.
[[nodiscard]] std::string to_json(const DiagnosisReport& outcome);

/// The better model's file: the model as text, and at its top what was changed and why.
/// With nothing missing it is the given model with its fitted parameters. Outcome::fitted() must
/// hold.
[[nodiscard]] std::string better_model_text(const DiagnosisReport& outcome);

/// The report of a diagnosis: verdict and figures at the top, the falling error, the candidates of
/// each round, the parameters, and each record held against the model before and after.
[[nodiscard]] present::Report report_of(const DiagnosisReport& outcome);

// Its parts.

[[nodiscard]] present::Section falling_error_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section candidates_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section parameters_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section where_section(const DiagnosisReport& outcome);
/// One section for each record.
[[nodiscard]] std::vector<present::Section> record_sections(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
