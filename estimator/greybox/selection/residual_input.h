// Ways in which a residual enters a model's equations, as a function of a variable of its motion.
//
//   flow     h_i volts beside the command          gain   u h_i volts beside the command
//   force    h_i newtons against extension         drag   v h_i newtons against extension
//   reading  h_i metres on the position            scale  (y - mean) h_i metres on the position
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/residual_variables.h"

namespace estimator::greybox::selection {

enum class ResidualInput { flow, gain, force, drag, reading, scale };

/// "flow", "gain", "force" or "measurement".
[[nodiscard]] const char* site_of(ResidualInput input);
/// Flow and gain, and force and drag where the model's plant has forces: those that the model's own
/// simulation answers.
[[nodiscard]] std::vector<ResidualInput> model_inputs(const plant_sim::ModelFile& model);

/// The pieces of a variable as values of the input, samples x pieces.
[[nodiscard]] Eigen::MatrixXd input_values(const ResidualVariables& all, const Variable& variable,
                                           ResidualInput input);
/// d residual / d input for one of model_inputs(), samples x pieces; zero where the input is.
[[nodiscard]] Eigen::MatrixXd input_responses(const SearchContext& context,
                                              const FitSummary& fitted,
                                              const ResidualVariables& all,
                                              const Variable& variable, ResidualInput input);

}  // namespace estimator::greybox::selection
