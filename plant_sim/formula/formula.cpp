#include "plant_sim/formula/formula.h"

#include <mutex>
#include <set>

#include "config/schema/error.h"
#include "plant_sim/formula/recorder.h"

namespace plant_sim {
namespace {

std::array<VariableRange, Tape::kVariables> ranges_of(Site site, const PlausibleRanges& ranges) {
  switch (site) {
    case Site::command:
      return {ranges.command_V, {}};
    case Site::opening:
      return {ranges.opening_m, {}};
    case Site::flow:
      return {ranges.flow_m3ps, {}};
    case Site::leakage:
      return {ranges.pressure_Pa, ranges.pressure_Pa};
    case Site::force:
      return {ranges.position_m, ranges.speed_mps};
    default:
      return {ranges.position_m, {}};
  }
}

}  // namespace

const char* interned(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> all;
  const std::lock_guard lock(mutex);
  return all.insert(text).first->c_str();
}

ParameterInfo info_of(const FormulaEffect::Parameter& p) {
  return {interned(p.name), interned(p.what), p.min, p.max, p.typical, p.neutral};
}

Formula compile(const FormulaEffect& effect, const PlausibleRanges& ranges,
                const std::string& where) {
  const FormulaSite* place = find_formula_site(effect.site);
  if (place == nullptr) {
    std::string sites;
    for (const FormulaSite& site : kFormulaSites) {
      sites += (sites.empty() ? "" : ", ") + std::string(site_name(site.site));
    }
    throw config::schema::bad_config(where + " site", "is " + effect.site, sites);
  }
  std::vector<std::string> variables;
  for (const char* name : place->variables) {
    if (*name != '\0') variables.emplace_back(name);
  }
  std::vector<std::string> names;
  std::vector<ParameterInfo> infos;
  for (const FormulaEffect::Parameter& p : effect.parameters) {
    names.push_back(p.name);
    infos.push_back(info_of(p));
  }
  return {effect.name, *place, record_formula(effect.formula, variables, names, where + " formula"),
          std::move(infos), ranges_of(place->site, ranges)};
}

Formulas::Formulas(std::vector<Formula> formulas)
    : formulas_(std::make_shared<const std::vector<Formula>>(std::move(formulas))) {
  for (const Formula& f : *formulas_) {
    views_.push_back({f.name.c_str(),
                      f.place.site,
                      f.place.guard,
                      f.parameters.data(),
                      view_of(f.tape),
                      {f.ranges[0], f.ranges[1]}});
  }
}

}  // namespace plant_sim
