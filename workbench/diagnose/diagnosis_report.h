// A finished diagnosis with the request that it answers, and what is made of it: text, JSON, model
// file and HTML report.
#pragma once

#include <functional>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/spectra/resonance.h"
#include "workbench/diagnose/request.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

struct DiagnosisReport {
  const PreparedDiagnosis* prepared = nullptr;  ///< must outlive this object
  selection::Diagnosis diagnosis;
  std::string advice;
  bool interrupted = false;
  bool out_of_time = false;  ///< interrupted by the time limit of the request
  /// Free run from each segment's first sample, all samples; NaN when nothing was fitted.
  double free_run_before_m = std::numeric_limits<double>::quiet_NaN();  ///< the file as it is
  double free_run_after_m = std::numeric_limits<double>::quiet_NaN();   ///< the better model
  /// The better model on what was not fitted, where records, halves or stated blocks are held out.
  double free_run_heldout_m = std::numeric_limits<double>::quiet_NaN();
  /// Resonance of the measured response that the better model's lacks.
  std::optional<estimator::spectra::Resonance> resonance = {};

  /// False when the records did not move enough for anything to be fitted.
  [[nodiscard]] bool fitted() const { return diagnosis.final.theta.size() > 0; }
  /// True for a record that has to be read differently before any effect is sought.
  [[nodiscard]] bool misread() const { return diagnosis.checks && diagnosis.checks->misread(); }
  [[nodiscard]] bool has_better_model() const { return fitted() && !misread(); }
};

/// Diagnoses with the options of `prepared`, which must outlive the report; the laws that are
/// learned are declared in its model. `interrupted` is asked once, at the end.
[[nodiscard]] DiagnosisReport run(PreparedDiagnosis& prepared,
                                  const std::function<bool()>& interrupted);

/// A diagnosis as text for a terminal: words first, then the figures.
void print(const DiagnosisReport& outcome, std::ostream& out);

/// A diagnosis as JSON, SI throughout; missing numbers are null.
[[nodiscard]] std::string to_json(const DiagnosisReport& outcome);

/// The better model's file: the model as text, and at its top what was changed and why.
/// With nothing missing it is the given model with its fitted parameters.
/// outcome.has_better_model() must hold.
[[nodiscard]] std::string better_model_text(const DiagnosisReport& outcome);

/// The report of a diagnosis: verdict and figures at the top, the falling error, the candidates of
/// each round, the parameters, and each record held against the model before and after.
[[nodiscard]] present::Report report_of(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
