#include "plant_sim/formula/formula.h"

#include <algorithm>
#include <cctype>
#include <mutex>
#include <set>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "plant_sim/formula/recorder.h"

namespace plant_sim::formula {
namespace {

using config::schema::bad_config;

std::array<VariableRange, ExpressionProgram::kVariables> ranges_of(effects::Site site,
                                                                   const PlausibleRanges& ranges) {
  switch (site) {
    case effects::Site::command:
      return {ranges.command_V, {}};
    case effects::Site::opening:
      return {ranges.opening_m, ranges.position_m};
    case effects::Site::flow:
      return {ranges.flow_m3ps, {}};
    case effects::Site::leakage:
      return {ranges.pressure_Pa, ranges.pressure_Pa};
    case effects::Site::force:
      return {ranges.position_m, ranges.speed_mps};
    default:
      return {ranges.position_m, {}};
  }
}

bool is_name(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); });
}

/// Names that muParser and model files can take, each with one meaning.
void check_names(const FormulaEffect& effect, const FormulaSite& place, const std::string& where) {
  if (!is_name(effect.name)) throw bad_config(where, "is no name", "letters, digits and _");
  const std::vector<std::string>& words = formula_words();
  for (const FormulaEffect::Parameter& p : effect.parameters) {
    const std::string its_table = where + " parameters." + p.name;
    if (!is_name(p.name)) throw bad_config(its_table, "is no name", "letters, digits and _");
    if (std::find(words.begin(), words.end(), p.name) != words.end() ||
        std::find(place.variables.begin(), place.variables.end(), p.name) !=
            place.variables.end()) {
      throw bad_config(its_table, "has the name of a function or variable", "another name");
    }
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
    const auto name = [](const FormulaSite& site) { return effects::site_name(site.site); };
    throw bad_config(where + " site", "is " + effect.site,
                     config::schema::joined_by(kFormulaSites, name));
  }
  check_names(effect, *place, where);
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

const FormulaView* Formulas::data() const { return views_.data(); }
std::size_t Formulas::size() const { return views_.size(); }

Formulas::Formulas(std::vector<Formula> formulas)
    : formulas_(std::make_shared<const std::vector<Formula>>(std::move(formulas))) {
  for (const Formula& f : *formulas_) {
    views_.push_back({f.name.c_str(),
                      f.place.site,
                      f.place.guard,
                      f.parameters.data(),
                      view_of(f.program),
                      {f.ranges[0], f.ranges[1]}});
  }
}

}  // namespace plant_sim::formula
