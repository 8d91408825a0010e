// Tracked parameters, and rivals that could explain the same change of the rig.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::tracking {

/// Tracked parameters first, then their rivals: every uncertain parameter of the plant, and effects
/// that may arise in operation.
struct ParameterSet {
  std::vector<FreeParameter> parameters;
  std::size_t tracked = 0;
  Eigen::VectorXd file;  ///< theta of the model file
  /// Uncertainty of the plant's values in the file (plant_sim::ParameterInfo::uncertainty_ratio);
  /// infinite for the others.
  Eigen::VectorXd uncertainty;

  [[nodiscard]] std::vector<std::size_t> tracked_indices() const;
  /// Supply pressure of the model file; NaN: the plant has no pressures.
  [[nodiscard]] double supply_Pa() const;
};

/// `lists`: comma-separated names as in model files. Throws config::schema::ConfigError that begins
/// with `option` for an unknown name.
[[nodiscard]] ParameterSet choose(const plant_sim::ModelFile& model,
                                  const std::vector<std::string>& lists, const std::string& option);

}  // namespace estimator::greybox::tracking
