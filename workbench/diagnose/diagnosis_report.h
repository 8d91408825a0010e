// A finished diagnosis with the request that it answers: the source of text, JSON, model file and
// HTML report.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"
#include "workbench/diagnose/request.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

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

}  // namespace workbench::diagnose
