// Every parameter that a model may be searched for, by the names of model files.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

/// A parameter that may be fitted.
struct Known {
  std::string name;
  std::string effect;  ///< empty: the plant's
  plant_sim::ParameterInfo info;
  SearchParameter search;
};

/// Of the plant, and of every effect that acts where the plant has a site.
[[nodiscard]] std::vector<Known> known_parameters(const plant_sim::ModelFile& model);

/// The whole range that the parameter may have, no prior.
void open_up(Known& known);

/// Of the plant and of effects that the model has: what a list of allowed names should show.
[[nodiscard]] std::vector<std::string> names_worth_showing(const plant_sim::ModelFile& model,
                                                           const std::vector<Known>& known);

/// Throws config::schema::ConfigError that names the option, what was typed, the nearest of
/// `near` and what is allowed.
[[noreturn]] void refuse_name(const std::string& option, const std::string& typed,
                              const std::vector<std::string>& near,
                              const std::vector<std::string>& shown_names);

/// Words of lists "a,b,c", one after the other.
[[nodiscard]] std::vector<std::string> split_names(const std::vector<std::string>& lists);

}  // namespace estimator::greybox
