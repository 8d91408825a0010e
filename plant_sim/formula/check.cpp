// Checks on a declared formula before simulation (formula.h).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "plant_sim/formula/formula.h"

namespace plant_sim::formula {
namespace {

using config::schema::bad_config;

constexpr std::size_t kMostParameters = 6;  // every combination of their bounds is tried
/// Points of a signal by the number of signals that a formula reads; odd: the middle, often 0, is
/// among them.
constexpr std::array kPoints = {401, 401, 21, 7, 5, 3};
/// Time over which a memory that does not settle adds up its rate, s.
constexpr double kAddsUp_s = 10.0;

std::string shown(double value) {
  if (std::isnan(value)) return "no number";
  if (std::isinf(value)) return "infinite";
  char buffer[32];
  return {buffer, std::to_chars(std::begin(buffer), std::end(buffer), value + 0.0).ptr};  // no -0
}

void check_parameter(const FormulaEffect::Parameter& p, bool used, const std::string& where) {
  if (!(p.min < p.max)) throw bad_config(where, "has no range", "min below max");
  const std::string range = shown(p.min) + " to " + shown(p.max);
  if (p.neutral < p.min || p.neutral > p.max) {
    throw bad_config(where + " neutral", "is " + shown(p.neutral) + ", out of range", range);
  }
  if (p.typical < p.min || p.typical > p.max) {
    throw bad_config(where + " typical", "is " + shown(p.typical) + ", out of range", range);
  }
  if (p.typical == p.neutral) {
    throw bad_config(where + " typical", "is the neutral value", "a value other than neutral");
  }
  if (!used) throw bad_config(where, "is not in the formula");
}

/// Signals that are tried: those that are read, and the one that a chained formula passes on.
std::vector<Signal> tried(const Formula& formula) {
  std::vector<Signal> signals = formula.reads();
  const Signal own = formula.place.first;
  const bool known = std::find(signals.begin(), signals.end(), own) != signals.end();
  if (formula.place.chained && !known) signals.push_back(own);
  return signals;
}

/// Calls f(signals) on a grid over the ranges of `over`, the others in the middle of theirs, until
/// it returns false.
template <class F>
void each_point(const Formula& formula, const std::vector<Signal>& over, F&& f) {
  const int count = kPoints[std::min(over.size(), kPoints.size() - 1)];
  Signals<double> at{};
  for (std::size_t i = 0; i < kSignals; ++i) {
    at[i] = 0.5 * (formula.ranges[i].min + formula.ranges[i].max);
  }
  std::vector<int> place(over.size(), 0);
  while (true) {
    for (std::size_t i = 0; i < over.size(); ++i) {
      const VariableRange& range = formula.ranges[over[i]];
      at[over[i]] = range.min + (range.max - range.min) * place[i] / (count - 1);
    }
    if (!f(at)) return;
    std::size_t digit = over.size();
    while (digit > 0 && ++place[digit - 1] == count) place[--digit] = 0;
    if (digit == 0) return;
  }
}

std::string point(const Formula& formula, const Signals<double>& at,
                  const std::vector<double>& values) {
  std::vector<std::string> parts;
  for (const Signal signal : tried(formula)) {
    parts.push_back(std::string(kSignalNames[signal]) + " = " + shown(at[signal]));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    parts.push_back(std::string(formula.parameters[i].name) + " = " + shown(values[i]));
  }
  return config::schema::joined(parts);
}

void check_neutral(const Formula& formula, ExpressionEvaluator<double>& run,
                   const std::string& where) {
  std::vector<double> neutral;
  for (const ParameterInfo& p : formula.parameters) neutral.push_back(p.neutral);
  run.set_parameters(neutral.data());
  each_point(formula, tried(formula), [&](const Signals<double>& at) {
    const double result = run(at.data());
    const Signal own = formula.place.first;
    if (result == (formula.place.chained ? at[own] : 0.0)) return true;
    throw bad_config(where,
                     "has influence when its parameters are neutral: " + shown(result) + " at " +
                         point(formula, at, neutral),
                     formula.place.chained ? std::string(kSignalNames[own]) + " itself" : "0");
  });
}

void check_finite(const Formula& formula, const ExpressionProgram& program,
                  const std::string& where) {
  ExpressionEvaluator<double> run(view_of(program));
  const std::size_t count = formula.parameters.size();
  // what has more is a curve, linear in its values
  std::size_t combinations = 1;
  for (std::size_t i = 0; i < count && count <= kMostParameters; ++i) combinations *= 3;
  std::vector<double> values(count);
  const auto try_out = [&] {
    run.set_parameters(values.data());
    each_point(formula, tried(formula), [&](const Signals<double>& at) {
      const double result = run(at.data());
      if (std::isfinite(result)) return true;
      throw bad_config(where, "is " + shown(result) + " at " + point(formula, at, values),
                       "finite values: bound the parameters, or guard with max() or if()");
    });
  };
  for (std::size_t i = 0; i < count; ++i) values[i] = formula.parameters[i].typical;
  try_out();
  for (std::size_t combination = 0; combination < combinations; ++combination) {
    std::size_t rest = combination;
    for (std::size_t i = 0; i < count; ++i, rest /= 3) {
      const ParameterInfo& p = formula.parameters[i];
      values[i] = rest % 3 == 0 ? p.neutral : rest % 3 == 1 ? p.min : p.max;
    }
    try_out();
  }
}

}  // namespace

VariableRange memory_range(const Formula& formula) {
  ExpressionEvaluator<double> rate(view_of(formula.memory));
  std::vector<double> typical;
  for (const ParameterInfo& p : formula.parameters) typical.push_back(p.typical);
  rate.set_parameters(typical.data());
  VariableRange range;
  std::vector<Signal> others = formula.reads();
  std::erase(others, kMemory);
  each_point(formula, others, [&](Signals<double> at) {
    at[kMemory] = 0.0;
    const double from_0 = rate(at.data());
    at[kMemory] = 1.0;
    const double slope = rate(at.data()) - from_0;
    const double end = slope < 0.0 ? -from_0 / slope : kAddsUp_s * from_0;
    if (std::isfinite(end)) range = {std::min(range.min, end), std::max(range.max, end)};
    return true;
  });
  return range;
}

void check(const FormulaEffect& effect, const Formula& formula, const std::string& where) {
  if (effect.parameters.empty()) {
    throw bad_config(where, "has no parameter", "at least one, in [.parameters.NAME]");
  }
  if (effect.parameters.size() > kMostParameters && !effect.curve) {
    throw bad_config(where, "has " + std::to_string(effect.parameters.size()) + " parameters",
                     "up to " + std::to_string(kMostParameters));
  }
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const FormulaEffect::Parameter& p = effect.parameters[i];
    const bool used = formula.program.uses[i] || (formula.remembers && formula.memory.uses[i]);
    check_parameter(p, used, where + " parameters." + p.name);
  }
  check_finite(formula, formula.program, where + " formula");
  if (formula.remembers) check_finite(formula, formula.memory, where + " memory");
  ExpressionEvaluator<double> run(view_of(formula.program));
  check_neutral(formula, run, where + " formula");
}

}  // namespace plant_sim::formula
