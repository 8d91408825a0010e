// Parameters to fit, with their bounds and priors: the engineer's words as search
// parameters.
//
//   --free, --fix  names as in model files ("mass_kg", "friction.coulomb_N"), or an effect's name
//   --prior        name=mean+-sd, sd in the parameter's unit or in % of the mean; name=none
//   --bounds       name=low:high, either may be left out
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/model_file.h"

namespace workbench::fit {

namespace greybox = estimator::greybox;

struct ParameterSelection {
  std::vector<std::string> free{};  ///< empty: the plant's uncertain ones and those of its effects
  std::vector<std::string> fix{};
  std::vector<std::string> priors{};
  std::vector<std::string> bounds{};
};

struct FreeParameters {
  std::vector<greybox::FreeParameter> parameters;
  Eigen::VectorXd start;
};

/// Throws config::schema::UsageError for a word that is not one of the above, ConfigError for an
/// unknown parameter or a value that it cannot have.
[[nodiscard]] FreeParameters select_parameters(const plant_sim::ModelFile& model,
                                               const ParameterSelection& selection);

/// Starts effects that the model has without a value from sizes that are typical of the rig and the
/// records: at zero, most have no slope.
void start_neutral_effects(const plant_sim::ModelFile& model, const greybox::FitDataset& data,
                           FreeParameters& choice);

/// A finite number and nothing else; NaN otherwise.
[[nodiscard]] double number_in(std::string_view text);

}  // namespace workbench::fit
