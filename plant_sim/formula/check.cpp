// Checks on a declared formula before simulation (formula.h).
#include <charconv>
#include <cmath>

#include "config/schema/error.h"
#include "plant_sim/formula/formula.h"

namespace plant_sim::formula {
namespace {

using config::schema::bad_config;

constexpr std::size_t kMostParameters = 6;  // every combination of their bounds is tried
constexpr int kPointsAlone = 401;           // odd: the middle, often 0, is among them
constexpr int kPointsEach = 21;

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

/// Calls f(values, result) on a grid over the variables' ranges, until it returns false.
template <class F>
void each_point(const Formula& formula, const ExpressionEvaluator<double>& run, F&& f) {
  const auto& [first, second] = formula.ranges;
  const bool alone = *formula.place.variables[1] == '\0';
  const int many = alone ? kPointsAlone : kPointsEach;
  const int few = alone ? 1 : kPointsEach;
  const auto at = [](const VariableRange& range, int i, int count) {
    return count == 1 ? range.min : range.min + (range.max - range.min) * i / (count - 1);
  };
  for (int i = 0; i < many; ++i) {
    for (int j = 0; j < few; ++j) {
      const double a = at(first, i, many);
      const double b = at(second, j, few);
      if (!f(a, b, run(a, b))) return;
    }
  }
}

std::string point(const Formula& formula, double a, double b, const std::vector<double>& values) {
  const auto& names = formula.place.variables;
  std::string text = std::string(names[0]) + " = " + shown(a);
  if (*names[1] != '\0') text += ", " + std::string(names[1]) + " = " + shown(b);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += ", " + std::string(formula.parameters[i].name) + " = " + shown(values[i]);
  }
  return text;
}

void check_neutral(const Formula& formula, ExpressionEvaluator<double>& run,
                   const std::string& where) {
  std::vector<double> neutral;
  for (const ParameterInfo& p : formula.parameters) neutral.push_back(p.neutral);
  run.set_parameters(neutral.data());
  each_point(formula, run, [&](double a, double b, double result) {
    const double none = formula.place.chained ? a : 0.0;
    if (result == none) return true;
    throw bad_config(
        where,
        "has influence when its parameters are neutral: " + shown(result) + " at " +
            point(formula, a, b, neutral),
        formula.place.chained ? std::string(formula.place.variables[0]) + " itself" : "0");
  });
}

void check_finite(const Formula& formula, ExpressionEvaluator<double>& run,
                  const std::string& where) {
  const std::size_t count = formula.parameters.size();
  std::size_t combinations = 1;
  for (std::size_t i = 0; i < count; ++i) combinations *= 3;
  std::vector<double> values(count);
  const auto try_out = [&] {
    run.set_parameters(values.data());
    each_point(formula, run, [&](double a, double b, double result) {
      if (std::isfinite(result)) return true;
      throw bad_config(where, "is " + shown(result) + " at " + point(formula, a, b, values),
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

void check(const FormulaEffect& effect, const Formula& formula, const std::string& where) {
  if (effect.parameters.empty()) {
    throw bad_config(where, "has no parameter", "at least one, in [.parameters.NAME]");
  }
  if (effect.parameters.size() > kMostParameters) {
    throw bad_config(where, "has " + std::to_string(effect.parameters.size()) + " parameters",
                     "up to " + std::to_string(kMostParameters));
  }
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const FormulaEffect::Parameter& p = effect.parameters[i];
    check_parameter(p, formula.program.uses[i], where + " parameters." + p.name);
  }
  ExpressionEvaluator<double> run(view_of(formula.program));
  check_finite(formula, run, where + " formula");
  check_neutral(formula, run, where + " formula");
}

}  // namespace plant_sim::formula
