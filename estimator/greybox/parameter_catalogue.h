// Catalogue of every parameter that can be fitted, by the names of model files.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

/// A parameter that can be fitted.
struct CatalogueParameter {
  std::string name;
  std::string effect;  ///< empty: a plant parameter
  plant_sim::ParameterInfo info;
  FreeParameter free;
};

/// Parameters of the plant and of every effect whose site the plant offers.
[[nodiscard]] std::vector<CatalogueParameter> parameter_catalogue(
    const plant_sim::ModelFile& model);

/// Widens to the parameter's whole range, without prior.
void widen_to_full_range(CatalogueParameter& known);

/// Names for a list of allowed values: parameters of the plant and of effects in the model.
[[nodiscard]] std::vector<std::string> suggested_names(
    const plant_sim::ModelFile& model, const std::vector<CatalogueParameter>& known);

/// Throws config::schema::ConfigError with the option, the typed name, the nearest name of `near`
/// and the allowed names.
[[noreturn]] void reject_name(const std::string& option, const std::string& typed,
                              const std::vector<std::string>& near,
                              const std::vector<std::string>& shown_names);

/// Names of comma-separated lists, concatenated, as the library has them.
[[nodiscard]] std::vector<std::string> split_names(const std::vector<std::string>& lists);

}  // namespace estimator::greybox
