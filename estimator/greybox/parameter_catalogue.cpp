#include "estimator/greybox/parameter_catalogue.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace estimator::greybox {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

void widen_to_full_range(CatalogueParameter& known) {
  FreeParameter& p = known.free;
  p.prior_mean = 0.0;
  p.prior_sd = kUnbounded;
  if (p.scale == ParameterScale::logarithmic) {
    p.lower = known.info.min > 0.0 ? std::log(known.info.min / p.unit) : -20.0;
    p.upper = std::log(known.info.max / p.unit);
  }
}

std::vector<CatalogueParameter> parameter_catalogue(const plant_sim::ModelFile& model) {
  std::vector<CatalogueParameter> found;
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(model.plant);
  const std::vector<FreeParameter> uncertain = plant_parameters(model);
  for (std::size_t i = 0; i < plant.parameters.size(); ++i) {
    CatalogueParameter known{plant.parameters[i].name, "", plant.parameters[i], {}};
    const auto same = [&](const FreeParameter& p) { return p.name == known.name; };
    const auto given = std::find_if(uncertain.begin(), uncertain.end(), same);
    if (given != uncertain.end()) {
      known.free = *given;
    } else {
      FreeParameter& p = known.free;
      const double value = model.parameters[i].value;
      p.name = known.name;
      p.scale = value > 0.0 ? ParameterScale::logarithmic : ParameterScale::linear;
      p.unit = value > 0.0 ? value : (known.info.typical > 0.0 ? known.info.typical : 1.0);
      p.lower = known.info.min / p.unit;
      p.upper = known.info.max / p.unit;
      widen_to_full_range(known);
    }
    found.push_back(known);
  }
  for (const plant_sim::EffectInfo& effect : plant_sim::effects_of(model)) {
    const auto fits = [&](const std::string& site) {
      return std::find(plant.sites.begin(), plant.sites.end(), site) != plant.sites.end();
    };
    if (!std::all_of(effect.sites.begin(), effect.sites.end(), fits)) continue;
    const auto all = effect_parameters(effect, kEveryRefinement);
    for (std::size_t i = 0; i < all.size(); ++i) {
      found.push_back({all[i].name, effect.name, effect.parameters[i], all[i]});
      found.back().free.in_model = is_given(model, effect.name, effect.parameters[i]);
    }
  }
  return found;
}

std::vector<std::string> suggested_names(const plant_sim::ModelFile& model,
                                         const std::vector<CatalogueParameter>& known) {
  std::vector<std::string> names;
  for (const CatalogueParameter& k : known) {
    const auto present = [&](const auto& e) { return e.present && e.name == k.effect; };
    if (k.effect.empty() || std::any_of(model.effects.begin(), model.effects.end(), present)) {
      names.push_back(k.name);
    }
  }
  return names;
}

void reject_name(const std::string& option, const std::string& typed,
                 const std::vector<std::string>& near,
                 const std::vector<std::string>& shown_names) {
  const std::string best = config::schema::nearest(typed, near);
  throw config::schema::bad_config(
      option + " " + typed,
      "is no parameter of this model" +
          (best.empty() ? std::string() : ", did you mean " + best + "?"),
      config::schema::joined(shown_names) + "; or an effect's, see `spoolwatch effects`");
}

std::vector<std::string> split_names(const std::vector<std::string>& lists) {
  std::vector<std::string> words;
  for (const std::string& list : lists) {
    std::size_t from = 0;
    while (from <= list.size()) {
      const std::size_t to = std::min(list.find(',', from), list.size());
      if (to > from) {
        words.push_back(plant_sim::library_name(list.substr(from, to - from)));
      }
      from = to + 1;
    }
  }
  return words;
}

}  // namespace estimator::greybox
