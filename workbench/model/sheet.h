// A sheet lists everything that a model file states or leaves to a default, and the quantities
// derived from it: for an engineer who holds it beside the data sheets of the rig.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plant_sim/model_file.h"

namespace workbench::model {

/// Values in SI, in the unit of the name's suffix.
struct SheetParameter {
  enum class Source { file, default_value, neutral };

  std::string name;  ///< "mass_kg", "friction.coulomb_N"
  std::string what;
  double value = 0.0;
  double min = 0.0;
  double max = 0.0;
  Source source = Source::file;
  double prior_ratio = 0.0;  ///< relative standard deviation; NaN: no prior
  bool fitted = false;       ///< free in `fit` and `diagnose` unless told otherwise
};

/// A quantity that follows from the parameters; the name carries its unit.
struct DerivedQuantity {
  std::string name;
  std::string what;
  double value = 0.0;
};

struct Sheet {
  plant_sim::ModelFile model;
  std::vector<SheetParameter> plant;
  std::vector<SheetParameter> initial;
  std::vector<SheetParameter> effects;  ///< parameters of the effects that the model has
  std::vector<DerivedQuantity> derived;
  std::string held_scale;  ///< sentence on what no record of command and position can tell; or ""
};

/// Throws config::schema::ConfigError like plant_sim::load_model.
[[nodiscard]] Sheet sheet_of(const std::filesystem::path& file,
                             const std::vector<std::string>& assignments);
/// Quantities derived from the values of the plant with the effects that it has, before any change.
[[nodiscard]] std::vector<DerivedQuantity> derived_quantities(const plant_sim::ModelFile& file);

[[nodiscard]] const char* to_string(SheetParameter::Source source);
[[nodiscard]] std::string to_text(const Sheet& sheet);
[[nodiscard]] std::string to_json(const Sheet& sheet);

}  // namespace workbench::model
