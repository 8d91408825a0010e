#include "workbench/add/declared_formula.h"

#include <algorithm>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace workbench::add {

using config::schema::error_line;
using config::schema::UsageError;
using plant_sim::ModelFile;
using plant_sim::formula::FormulaEffect;

void require_site(const ModelFile& model, const std::string& site, const std::string& where) {
  const std::vector<std::string>& offered = plant_sim::find_plant(model.plant)->sites;
  std::vector<std::string> names;
  for (const plant_sim::formula::FormulaSite& one : plant_sim::formula::kFormulaSites) {
    const std::string name = plant_sim::effects::site_name(one.site);
    if (std::find(offered.begin(), offered.end(), name) != offered.end()) names.push_back(name);
  }
  if (std::find(names.begin(), names.end(), site) != names.end()) return;
  const bool exists = plant_sim::formula::find_formula_site(site) != nullptr;
  const std::string near = config::schema::nearest(site, names);
  throw UsageError(error_line(
      where,
      exists
          ? "acts at the site " + site + ", which " + model.plant + " does not have"
          : "has the unknown site " + site + (near.empty() ? "" : ", did you mean " + near + "?"),
      config::schema::joined(names)));
}

AddedEffect declared(ModelFile model, const FormulaEffect& effect,
                     const std::vector<double>& values, const std::string& where) {
  for (const ModelFile::Effect& entry : model.effects) {
    if (entry.name != effect.name) continue;
    throw UsageError(
        error_line(where, "would be a second effect " + effect.name, "another name, by --name"));
  }
  try {
    model.declare(effect, where);
  } catch (const config::schema::ConfigError& error) {
    throw UsageError(error.what());
  }
  AddedEffect out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const FormulaEffect::Parameter& p = effect.parameters[i];
    if (!(values[i] >= p.min && values[i] <= p.max)) {
      throw UsageError(error_line(p.name, "is " + number_text(values[i]) + ", out of range",
                                  number_text(p.min) + " to " + number_text(p.max)));
    }
    *model.value(effect.name + "." + p.name) = values[i];
    out.neutral = out.neutral && values[i] == p.neutral;
  }
  const std::vector<plant_sim::EffectInfo> all = plant_sim::effects_of(model);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name != effect.name) continue;
    out.effect = all[i];
    out.values = model.effects[i];
  }
  out.model = std::move(model);
  return out;
}

}  // namespace workbench::add
