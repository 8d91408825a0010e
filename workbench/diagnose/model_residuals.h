// Residuals of the model file and of the better model over the records of a diagnosis.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// Measured less modelled position of the long series, under the observer or without (0).
[[nodiscard]] Eigen::VectorXd residual_of_file_m(const selection::DiagnosisProblem& problem,
                                                 double observer_per_s);
[[nodiscard]] Eigen::VectorXd residual_of_m(const selection::DiagnosisProblem& problem,
                                            const greybox::FitSummary& fitted,
                                            double observer_per_s);

/// The same of a model whose values are final.
[[nodiscard]] Eigen::VectorXd residual_of_model_m(const plant_sim::ModelFile& model,
                                                  const greybox::FitDataset& data,
                                                  double observer_per_s);

/// The part of a long series that belongs to the record that begins at `start`; NaN where its
/// samples do not count, and throughout for an empty series.
[[nodiscard]] std::vector<double> counted_part(const Eigen::VectorXd& series_m, std::size_t start,
                                               const greybox::Dataset& record);

/// Residual of the better model, with the laws and changes it has beside the library's effects.
[[nodiscard]] Eigen::VectorXd residual_of_better_m(const DiagnosisReport& outcome,
                                                   double observer_per_s);

/// The same a standard deviation away along each of the widest directions of the parameters'
/// uncertainty, one column each; no columns where no error is known.
[[nodiscard]] Eigen::MatrixXd deviated_residuals_m(const DiagnosisReport& outcome,
                                                   double observer_per_s);

/// Fills in the free-run errors, and the resonance that the better model lacks.
void simulate_freely(DiagnosisReport& outcome);

}  // namespace workbench::diagnose
