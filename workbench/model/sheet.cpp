#include "workbench/model/sheet.h"

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "estimator/greybox/free_parameter.h"
#include "estimator/greybox/held_scale.h"
#include "plant_sim/library.h"
#include "workbench/present/printed_axis.h"

namespace workbench::model {
namespace {

using estimator::greybox::FreeParameter;
using plant_sim::ModelFile;
using plant_sim::ParameterInfo;

const FreeParameter* find(const std::vector<FreeParameter>& free, const std::string& name) {
  const auto same = [&](const FreeParameter& p) { return p.name == name; };
  const auto found = std::find_if(free.begin(), free.end(), same);
  return found == free.end() ? nullptr : &*found;
}

SheetParameter row(const std::string& name, const ParameterInfo& info, double value, double stated,
                   SheetParameter::Source otherwise, const std::vector<FreeParameter>& free) {
  SheetParameter out;
  out.name = name;
  out.what = info.what;
  out.value = value;
  out.min = info.min;
  out.max = info.max;
  out.source = std::isnan(stated) ? otherwise : SheetParameter::Source::file;
  const FreeParameter* fitted = find(free, name);
  out.fitted = fitted != nullptr;
  out.prior_ratio = out.fitted && std::isfinite(fitted->prior_sd) ? fitted->prior_sd : std::nan("");
  return out;
}

std::vector<FreeParameter> free_parameters(const ModelFile& model) {
  std::vector<FreeParameter> free = estimator::greybox::plant_parameters(model);
  for (FreeParameter& p : estimator::greybox::present_parameters(model)) free.push_back(p);
  return free;
}

void list_effects(const ModelFile& stated, const std::vector<FreeParameter>& free, Sheet& sheet) {
  const std::vector<plant_sim::EffectInfo> infos = plant_sim::effects_of(sheet.model);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const ModelFile::Effect& effect = sheet.model.effects[i];
    if (!effect.present) continue;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      sheet.effects.push_back(row(effect.name + "." + effect.parameters[k].name,
                                  infos[i].parameters[k], effect.parameters[k].value,
                                  stated.effects[i].parameters[k].value,
                                  SheetParameter::Source::neutral, free));
    }
  }
}

}  // namespace

const char* to_string(SheetParameter::Source source) {
  switch (source) {
    case SheetParameter::Source::file:
      return "file";
    case SheetParameter::Source::default_value:
      return "default";
    case SheetParameter::Source::neutral:
      break;
  }
  return "neutral";
}

Sheet sheet_of(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  auto document = config::schema::Document::load(file);
  for (const std::string& assignment : assignments) document.set(assignment);
  Sheet sheet;
  sheet.model = plant_sim::read_model(document);
  const ModelFile stated = plant_sim::stated_values(sheet.model, document);
  const std::vector<FreeParameter> free = free_parameters(sheet.model);
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(sheet.model.plant);
  for (std::size_t i = 0; i < plant.parameters.size(); ++i) {
    sheet.plant.push_back(row(plant.parameters[i].name, plant.parameters[i],
                              sheet.model.parameters[i].value, stated.parameters[i].value,
                              SheetParameter::Source::default_value, free));
  }
  for (std::size_t i = 0; i < plant.initial.size(); ++i) {
    sheet.initial.push_back(row(std::string("initial.") + plant.initial[i].name, plant.initial[i],
                                sheet.model.initial[i].value, stated.initial[i].value,
                                SheetParameter::Source::default_value, free));
  }
  list_effects(stated, free, sheet);
  sheet.derived = derived_quantities(sheet.model);
  std::vector<std::string> names;
  names.reserve(free.size());
  for (const FreeParameter& p : free) names.push_back(p.name);
  const present::PrintedAxis axis(present::motion_of(sheet.model));
  sheet.held_scale = estimator::greybox::held_scale_words(sheet.model, names);
  return sheet;
}

}  // namespace workbench::model
