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

/// Laws of the dictionary: those that are held against named effects; with them those of the level
/// of a friction, which stand beside it; with these the forms that come near to effects of the
/// library, for records that no effect explains.
enum class LawChoice { against_effects, beside_effects, unexplained };

/// Those that the plant has a site for, their sizes scaled to the rig. A law whose name the model
/// has given to a formula of its own is left out.
[[nodiscard]] std::vector<Law> law_dictionary(const plant_sim::ModelFile& model,
                                              const FitDataset& data,
                                              LawChoice choice = LawChoice::unexplained);

}  // namespace estimator::greybox::selection
