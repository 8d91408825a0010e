// A model with one effect more, or with other values of one that it has.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace workbench::add {

struct AddedEffect {
  plant_sim::ModelFile model;
  plant_sim::EffectInfo effect;
  plant_sim::ModelFile::Effect values;  ///< its entry in the model
  bool neutral = true;                  ///< every value is neutral
};

struct Assignment {
  std::string name;
  double value = 0.0;
};
/// One "parameter=number". Throws config::schema::UsageError for anything else.
[[nodiscard]] Assignment parse_assignment(const std::string& text);

/// The model of `file` with `effect`, of the library or declared as a formula in the file;
/// `assignments` are "parameter=number". Throws config::schema::UsageError and ConfigError for
/// names and values that are not allowed.
[[nodiscard]] AddedEffect add_effect(const std::string& file, const std::string& effect,
                                     const std::vector<std::string>& assignments);

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(double value);

}  // namespace workbench::add
