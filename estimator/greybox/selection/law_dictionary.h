// Laws that the library has no name for, as formulas at a site: candidates where no effect of the
// library explains a record. Each has at most three parameters, of which the first is its size.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "plant_sim/formula/formula_effect.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

struct Law {
  plant_sim::formula::FormulaEffect effect;
  std::vector<std::string> variables;  ///< "y", "v", "u", "speed", "direction", "pressure"
};

/// Laws of the dictionary; each choice has those of the one before.
enum class LawChoice {
  against_effects,  ///< in the place of named effects
  beside_effects,   ///< also laws of a friction's level, which stand beside it
  unexplained       ///< also forms that come near to named effects: no effect explains the record
};

/// Those that the plant has a site for, their sizes scaled to the rig. A law whose name the model
/// has given to a formula of its own is left out.
[[nodiscard]] std::vector<Law> law_dictionary(const plant_sim::ModelFile& model,
                                              const FitDataset& data,
                                              LawChoice choice = LawChoice::unexplained);

inline constexpr const char* kReadingScale = "reading_scale";
inline constexpr const char* kReadingScaleWords = "position sensor whose scale is off";

/// Laws that a record shows where their sizes change within it alone: a constant scale of the
/// position sensor is a gain.
[[nodiscard]] std::vector<Law> changing_laws(const plant_sim::ModelFile& model,
                                             const FitDataset& data);

}  // namespace estimator::greybox::selection
