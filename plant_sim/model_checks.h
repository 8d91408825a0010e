// Checks of a model file beyond the ranges of its numbers.
#pragma once

#include <string>

#include "plant_sim/formula/formula.h"
#include "plant_sim/model_file.h"

namespace plant_sim {

/// The effect's table of the file, for messages.
[[nodiscard]] std::string table_of(const formula::FormulaEffect& effect, const std::string& file);

/// Plausible ranges of formula variables on this plant: commands of +-10 V, the whole stroke, twice
/// the supply pressure.
[[nodiscard]] formula::PlausibleRanges plausible_ranges(const ModelFile& model);

/// Throws config::schema::ConfigError for a declared effect whose name is taken or whose formula or
/// points are not usable. `file` names the model in the message.
void check_declared(const ModelFile& model, const formula::FormulaEffect& effect,
                    const std::string& file);

/// Throws config::schema::ConfigError unless the plant can be simulated with the model's effects,
/// priors and changes. Gives parameters of changes the names that the library prints.
void check_model(ModelFile& model, const std::string& file);

}  // namespace plant_sim
