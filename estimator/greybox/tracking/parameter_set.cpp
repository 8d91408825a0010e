#include "estimator/greybox/tracking/parameter_set.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "config/schema/error.h"
#include "estimator/greybox/parameter_catalogue.h"

namespace estimator::greybox::tracking {
namespace {

/// Range in logarithms: a factor of about three either way.
constexpr double kWidest = 1.2;
constexpr double kNone = std::numeric_limits<double>::infinity();

/// Effects that may arise on a rig without them; the first parameter of each.
constexpr const char* kEffects[] = {"null_bias.offset_V",
                                    "internal_leakage.conductance_m3ps_per_Pa",
                                    "external_leakage.conductance_m3ps_per_Pa",
                                    "friction.coulomb_N",
                                    "quadratic_damping.coefficient_N_s2_per_m2",
                                    "load_force.force_N",
                                    "supply_droop.droop_Pa_per_m3ps",
                                    "flow_asymmetry.asymmetry_ratio",
                                    "entrained_air.fraction_ratio"};

bool has_sites(const plant_sim::ModelFile& model, const std::string& name) {
  const auto* const effect = plant_sim::find_effect(name.substr(0, name.find('.')));
  const auto& sites = plant_sim::find_plant(model.plant)->sites;
  return effect != nullptr &&
         std::all_of(effect->sites.begin(), effect->sites.end(), [&](const std::string& site) {
           return std::find(sites.begin(), sites.end(), site) != sites.end();
         });
}

std::vector<std::string> rivals(const plant_sim::ModelFile& model) {
  std::vector<std::string> names;
  for (const auto& p : plant_parameters(model)) names.push_back(p.name);
  for (const char* effect : kEffects) {
    if (has_sites(model, effect)) names.emplace_back(effect);
  }
  return names;
}

}  // namespace

std::vector<std::size_t> ParameterSet::tracked_indices() const {
  std::vector<std::size_t> indices(tracked);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

double ParameterSet::supply_Pa() const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name != "supply_pressure_Pa") continue;
    return parameters[i].to_physical(file[static_cast<Eigen::Index>(i)]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

ParameterSet choose(const plant_sim::ModelFile& model, const std::vector<std::string>& lists,
                    const std::string& option) {
  const std::vector<CatalogueParameter> known = parameter_catalogue(model);
  ParameterSet out;
  const auto add = [&](const std::string& name) {
    bool found = false;
    for (const CatalogueParameter& k : known) {
      if (k.name != name && k.effect != name) continue;
      found = true;
      const auto same = [&](const auto& p) { return p.name == k.name; };
      if (std::none_of(out.parameters.begin(), out.parameters.end(), same)) {
        out.parameters.push_back(k.free);
      }
    }
    if (found) return;
    std::vector<std::string> all;
    all.reserve(known.size());
    for (const CatalogueParameter& k : known) all.push_back(k.name);
    reject_name(option, name, all, suggested_names(model, known));
  };
  for (const std::string& name : split_names(lists)) add(name);
  out.tracked = out.parameters.size();
  if (out.tracked == 0) {
    throw config::schema::bad_config(option, "names no parameter", "one or more, by comma");
  }
  for (const std::string& rival : rivals(model)) add(rival);
  out.file = start_of(model, out.parameters);
  out.uncertainty = Eigen::VectorXd::Constant(out.file.size(), kNone);
  const auto uncertain = plant_parameters(model);
  for (std::size_t i = 0; i < out.parameters.size(); ++i) {
    FreeParameter& p = out.parameters[i];
    const auto same = std::find_if(uncertain.begin(), uncertain.end(),
                                   [&](const auto& other) { return other.name == p.name; });
    if (same != uncertain.end()) out.uncertainty[static_cast<Eigen::Index>(i)] = same->prior_sd;
    p.prior_mean = 0.0;
    p.prior_sd = kNone;
    if (p.scale != ParameterScale::logarithmic) continue;
    p.lower = -kWidest;
    p.upper = kWidest;
  }
  return out;
}

}  // namespace estimator::greybox::tracking
