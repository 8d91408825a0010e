// A formula, complete with ranges, put into a model with its values.
#pragma once

#include <string>
#include <vector>

#include "workbench/add/own_formula.h"

namespace workbench::add {

/// Throws config::schema::UsageError unless `site` takes formulas, and `model`'s plant has it.
/// `where` begins messages: the option.
void require_site(const plant_sim::ModelFile& model, const std::string& site,
                  const std::string& where);

/// Declares `effect` in `model` with `values` of its parameters, in their order. Throws
/// config::schema::UsageError where the model has one of that name or cannot have it.
[[nodiscard]] AddedEffect declared(plant_sim::ModelFile model,
                                   const plant_sim::formula::FormulaEffect& effect,
                                   const std::vector<double>& values, const std::string& where);

}  // namespace workbench::add
