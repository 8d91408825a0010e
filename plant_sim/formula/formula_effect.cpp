#include "plant_sim/formula/formula_effect.h"

#include <iterator>

#include "config/schema/visitor.h"

namespace plant_sim::formula {

using config::schema::Visitor;

void FormulaEffect::Parameter::visit(Visitor& v) {
  // finite: every bound is tried before the formula is accepted
  constexpr config::schema::Range kFinite{-1e300, 1e300};
  v.text({"what", "meaning in one phrase"}, what);
  v.number({"min", "smallest allowed value", true}, min, kFinite);
  v.number({"max", "largest allowed value", true}, max, kFinite);
  v.number({"typical", "typical size", true}, typical, kFinite);
  v.number({"neutral", "value without effect"}, neutral, kFinite);
}

void FormulaEffect::visit(Visitor& v) {
  std::vector<std::string_view> sites;
  sites.reserve(std::size(kFormulaSites));
  for (const FormulaSite& one : kFormulaSites) sites.emplace_back(effects::site_name(one.site));
  v.choice({"site", "site of the effect", true}, site, sites);
  v.text({"formula", "an expression of the site's variables and its parameters", true}, formula);
  v.text({"what", "meaning in one phrase"}, what);
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  names = v.names({"parameters", "one table for each"}, names);
  v.table("parameters", [&](Visitor& t) {
    parameters.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      parameters[i].name = names[i];
      t.table(names[i].c_str(), [&](Visitor& p) { parameters[i].visit(p); });
    }
  });
}

const FormulaSite* find_formula_site(std::string_view name) {
  for (const FormulaSite& site : kFormulaSites) {
    if (name == effects::site_name(site.site)) return &site;
  }
  return nullptr;
}

}  // namespace plant_sim::formula
