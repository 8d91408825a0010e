// Refinements without influence, such as static friction below the sliding one: no gradient leads a
// fit out of there, only another start.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/fit.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// Starts in which refinements that have no influence at the fit's solution have one again: sizes
/// in the unit of the effect's first parameter in the library's proportion to it, as fitted or as
/// the model has it; others at a third, the whole and three times the typical size. None where all
/// have influence, or without a Jacobian.
[[nodiscard]] std::vector<Eigen::VectorXd> revived_refinements(const plant_sim::ModelFile& model,
                                                               const FitSummary& fitted);

}  // namespace estimator::greybox::selection
