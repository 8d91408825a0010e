// Residuals of the model file and of the better model over the records of a diagnosis.
#pragma once

#include <Eigen/Core>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// Measured less modelled position of the long series, under the observer or without (0).
[[nodiscard]] Eigen::VectorXd residual_of_file_m(const selection::DiagnosisProblem& problem,
                                                 double observer_per_s);
[[nodiscard]] Eigen::VectorXd residual_of_m(const selection::DiagnosisProblem& problem,
                                            const greybox::FitSummary& fitted,
                                            double observer_per_s);

/// The same of the better model, with the laws and changes it has beside the library's effects.
[[nodiscard]] Eigen::VectorXd residual_of_better_m(const DiagnosisReport& outcome,
                                                   double observer_per_s);

/// Fills in the free-run errors.
void simulate_freely(DiagnosisReport& outcome);

}  // namespace workbench::diagnose
