#include "plant_sim/formula/formula.h"

#include <algorithm>
#include <cctype>
#include <mutex>
#include <set>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "plant_sim/formula/recorder.h"

namespace plant_sim::formula {
namespace {

using config::schema::bad_config;

/// Names of the signals that a formula may read, by their place; "" for the others.
std::vector<std::string> variables_of(const FormulaEffect& effect, const FormulaSite& place,
                                      const PlausibleRanges& ranges) {
  std::vector<std::string> names(kSignalNames.begin(), kSignalNames.end());
  if (!ranges.has_opening) names[kSpool].clear();
  if (!ranges.has_pressures) {
    names[kInPressure].clear();
    names[kOutPressure].clear();
  }
  if (place.site != effects::Site::flow) names[kFlow].clear();
  if (effect.memory.empty()) names[kMemory].clear();
  return names;
}

std::vector<std::string> names_of(const std::vector<FormulaEffect::Parameter>& parameters) {
  std::vector<std::string> names;
  for (const FormulaEffect::Parameter& p : parameters) names.push_back(p.name);
  return names;
}

ExpressionProgram memory_of(const FormulaEffect& effect, const std::vector<std::string>& variables,
                            const ExpressionProgram& formula, const std::string& where) {
  if (effect.memory.empty()) return {};
  const auto reads_memory = [](std::size_t signal) { return signal == kMemory; };
  if (std::none_of(formula.reads.begin(), formula.reads.end(), reads_memory)) {
    throw bad_config(where + " memory", "is not in the formula", "a formula of z");
  }
  return record_formula(effect.memory, variables, names_of(effect.parameters), where + " memory");
}

bool is_name(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); });
}

/// Names that muParser and model files can take, each with one meaning.
void check_names(const FormulaEffect& effect, const std::string& where) {
  if (!is_name(effect.name)) throw bad_config(where, "is no name", "letters, digits and _");
  const std::vector<std::string>& words = formula_words();
  for (const FormulaEffect::Parameter& p : effect.parameters) {
    const std::string its_table = where + " parameters." + p.name;
    if (!is_name(p.name)) throw bad_config(its_table, "is no name", "letters, digits and _");
    if (std::find(words.begin(), words.end(), p.name) != words.end() ||
        std::find(kSignalNames.begin(), kSignalNames.end(), p.name) != kSignalNames.end()) {
      throw bad_config(its_table, "has the name of a function or variable", "another name");
    }
  }
}

/// Throws unless the table's signals are among those that a formula there may read.
void check_signals(const CurveTable& curve, std::vector<std::string> variables,
                   const std::string& where) {
  std::erase(variables, "");
  const auto check_signal = [&](const char* key, const std::string& name) {
    if (std::find(variables.begin(), variables.end(), name) != variables.end()) return;
    const std::string near = config::schema::nearest(name, variables);
    throw bad_config(
        where + " " + key,
        "is no signal that it sees: " + name + (near.empty() ? "" : ", did you mean " + near + "?"),
        config::schema::joined(variables));
  };
  check_signal("over", curve.over);
  if (!curve.times.empty()) check_signal("times", curve.times);
}

Signal signal_named(const std::string& name) {
  return static_cast<Signal>(std::find(kSignalNames.begin(), kSignalNames.end(), name) -
                             kSignalNames.begin());
}

CurveView curve_of(const Formula& formula) {
  if (!formula.curve) return {};
  const CurveTable& table = *formula.curve;
  return {table.x.data(), table.x.size(), signal_named(table.over), signal_named(table.times),
          formula.place.chained ? formula.place.first : kSignals};
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
  check_names(effect, where);
  const std::vector<std::string> variables = variables_of(effect, *place, ranges);
  if (effect.curve) check_signals(*effect.curve, variables, where);
  Formula formula;
  formula.name = effect.name;
  formula.place = *place;
  for (const FormulaEffect::Parameter& p : effect.parameters) {
    formula.parameters.push_back(info_of(p));
  }
  formula.program =
      record_formula(effect.formula, variables, names_of(effect.parameters), where + " formula");
  formula.memory = memory_of(effect, variables, formula.program, where);
  formula.remembers = !effect.memory.empty();
  formula.curve = effect.curve;
  formula.ranges = {ranges.command_V, ranges.position_m,       ranges.speed_mps,
                    ranges.opening_m, ranges.pressure_Pa,      ranges.pressure_Pa,
                    ranges.flow_m3ps, ranges.acceleration_mps2};
  if (formula.remembers) formula.ranges[kMemory] = memory_range(formula);
  return formula;
}

std::vector<Signal> Formula::reads() const {
  std::vector<Signal> signals;
  for (std::size_t i = 0; i < kSignals; ++i) {
    const auto has = [&](const ExpressionProgram& one) {
      return std::find(one.reads.begin(), one.reads.end(), i) != one.reads.end();
    };
    if (has(program) || has(memory)) signals.push_back(static_cast<Signal>(i));
  }
  return signals;
}

const FormulaView* Formulas::data() const { return views_.data(); }
std::size_t Formulas::size() const { return views_.size(); }

Formulas::Formulas(std::vector<Formula> formulas)
    : formulas_(std::make_shared<const std::vector<Formula>>(std::move(formulas))) {
  for (const Formula& f : *formulas_) {
    views_.push_back({f.name.c_str(),
                      f.place,
                      f.parameters.data(),
                      view_of(f.program),
                      view_of(f.memory),
                      f.remembers,
                      curve_of(f),
                      {}});
    std::copy(f.ranges.begin(), f.ranges.end(), std::begin(views_.back().ranges));
  }
}

}  // namespace plant_sim::formula
