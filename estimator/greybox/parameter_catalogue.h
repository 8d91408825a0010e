// Every parameter that a model may be searched for, by the names of model files.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

/// A parameter that may be fitted.
struct CatalogueParameter {
  std::string name;
  std::string effect;  ///< empty: the plant's
  plant_sim::ParameterInfo info;
  FreeParameter free;
};

/// Of the plant, and of every effect that acts where the plant has a site.
[[nodiscard]] std::vector<CatalogueParameter> parameter_catalogue(
    const plant_sim::ModelFile& model);

/// The whole range that the parameter may have, no prior.
void widen_to_full_range(CatalogueParameter& known);

/// Of the plant and of effects that the model has: what a list of allowed names should show.
[[nodiscard]] std::vector<std::string> suggested_names(
    const plant_sim::ModelFile& model, const std::vector<CatalogueParameter>& known);

/// Throws config::schema::ConfigError that names the option, what was typed, the nearest of
/// `near` and what is allowed.
[[noreturn]] void reject_name(const std::string& option, const std::string& typed,
                              const std::vector<std::string>& near,
                              const std::vector<std::string>& shown_names);

/// Words of lists "a,b,c", one after the other.
[[nodiscard]] std::vector<std::string> split_names(const std::vector<std::string>& lists);

}  // namespace estimator::greybox
