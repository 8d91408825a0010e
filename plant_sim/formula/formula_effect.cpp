#include "plant_sim/formula/formula_effect.h"

#include <iterator>

#include "config/schema/visitor.h"
#include "plant_sim/formula/curve_effect.h"

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
  if (curve) {
    visit_curve(v);
    return;
  }
  v.text({"formula", "an expression of the site's variables and its parameters", true}, formula);
  v.text({"memory", "rate of change of the memory z, an expression like the formula"}, memory);
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

void FormulaEffect::visit_curve(Visitor& v) {
  constexpr config::schema::Range kFinite{-1e300, 1e300};
  v.text({"over", "signal that the curve goes over", true}, curve->over);
  v.text({"times", "further signal, by which the curve is multiplied"}, curve->times);
  v.numbers({"x", "points of the curve, ascending", true}, curve->x, kFinite);
  v.numbers({"f", "values of the curve there, in the unit of the site", true}, curve->f, kFinite);
  v.text({"what", "meaning in one phrase"}, what);
  derive_formula(*this);
}

std::string FormulaEffect::equation() const {
  if (!curve) return formula;
  const FormulaSite* const place = find_formula_site(site);
  const bool chained = place != nullptr && place->chained;
  return (chained ? std::string(kSignalNames[place->first]) + " + " : std::string()) +
         (curve->times.empty() ? "" : curve->times + " * ") + "f(" + curve->over + ")";
}

const FormulaSite* find_formula_site(std::string_view name) {
  for (const FormulaSite& site : kFormulaSites) {
    if (name == effects::site_name(site.site)) return &site;
  }
  return nullptr;
}

}  // namespace plant_sim::formula
