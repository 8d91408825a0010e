#include "workbench/add/own_formula.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "workbench/add/declared_formula.h"

namespace workbench::add {
namespace {

using config::schema::error_line;
using config::schema::UsageError;
using plant_sim::ModelFile;
using plant_sim::formula::Formula;
using plant_sim::formula::FormulaEffect;

constexpr const char* kOption = "--formula";
/// A parameter's range, over the size that it is given with; the widest that keeps the formula
/// finite is taken.
constexpr double kReaches[] = {1e3, 1e2, 10.0, 3.0};

std::string trimmed(const std::string& text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_space).base();
  return begin < end ? std::string(begin, end) : "";
}

FormulaEffect parsed(const std::string& text, const std::string& name) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw UsageError(error_line(kOption, "has no site: " + text,
                                "SITE: EXPRESSION, as in \"force: c*v_mps^3\""));
  }
  FormulaEffect effect;
  effect.site = trimmed(text.substr(0, colon));
  effect.formula = trimmed(text.substr(colon + 1));
  effect.name = name.empty() ? "own_" + effect.site : name;
  return effect;
}

std::vector<double> given(FormulaEffect& effect, const std::vector<std::string>& assignments) {
  std::vector<double> values;
  for (const std::string& text : assignments) {
    const Assignment one = parse_assignment(text);
    for (const FormulaEffect::Parameter& p : effect.parameters) {
      if (p.name == one.name) throw UsageError(one.name + ": is given twice");
    }
    if (one.value == 0.0 || !std::isfinite(one.value)) {
      throw UsageError(
          error_line(text, "is no size that a fit can start from", "a number above or below 0"));
    }
    effect.parameters.push_back({one.name, "", 0.0, 0.0, one.value, 0.0});
    values.push_back(one.value);
  }
  if (values.empty()) {
    throw UsageError(error_line(kOption, "has no parameter", "at least one, as c=1e5"));
  }
  return values;
}

/// Parses the expression; every name in it is a variable of the site or a parameter, and every
/// parameter is in it.
void require_complete(const FormulaEffect& effect) {
  try {
    const Formula formula = compile(effect, {}, kOption);
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (formula.program.uses[i] || (formula.remembers && formula.memory.uses[i])) continue;
      throw UsageError(error_line(effect.parameters[i].name, "is not in the formula",
                                  "parameters of " + effect.formula));
    }
  } catch (const config::schema::ConfigError& error) {
    throw UsageError(error.what() + std::string("; parameters are given as NAME=NUMBER"));
  }
}

/// Sizes have no influence at 0; the others, as a width below a fraction bar, keep their sign.
void choose_ranges(FormulaEffect& effect, unsigned sizes, double reach, bool either_sign) {
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    FormulaEffect::Parameter& p = effect.parameters[i];
    const bool is_size = (sizes >> i & 1U) != 0;
    const double most = p.typical * reach;
    const double least = !is_size ? p.typical / reach : either_sign ? -most : 0.0;
    p.min = std::min(least, most);
    p.max = std::max(least, most);
    p.neutral = is_size ? 0.0 : 2.0 * p.typical;
  }
}

/// Ranges with which the model takes the formula: the most sizes first, each as wide as it can be.
FormulaEffect with_ranges(const ModelFile& model, FormulaEffect effect) {
  const auto count = static_cast<unsigned>(effect.parameters.size());
  constexpr unsigned kMostParameters = 6;  // more are refused by declare()
  std::vector<unsigned> choices;
  for (unsigned sizes = 1; sizes < (1U << std::min(count, kMostParameters)); ++sizes) {
    choices.push_back(sizes);
  }
  std::stable_sort(choices.begin(), choices.end(),
                   [](unsigned a, unsigned b) { return std::popcount(a) > std::popcount(b); });
  std::string refusal;
  for (const double reach : kReaches) {
    for (const unsigned sizes : choices) {
      for (const bool either_sign : {true, false}) {
        choose_ranges(effect, sizes, reach, either_sign);
        try {
          ModelFile(model).declare(effect, kOption);
          return effect;
        } catch (const config::schema::ConfigError& error) {
          if (refusal.empty()) refusal = error.what();
        }
      }
    }
  }
  throw UsageError(refusal);
}

}  // namespace

AddedEffect add_formula(const std::string& file, const std::string& text, const std::string& memory,
                        const std::string& name, const std::vector<std::string>& assignments) {
  ModelFile model = plant_sim::load_model(file);
  FormulaEffect effect = parsed(text, name);
  effect.memory = memory;
  require_site(model, effect.site, kOption);
  const std::vector<double> values = given(effect, assignments);
  require_complete(effect);
  effect = with_ranges(model, std::move(effect));
  return declared(std::move(model), effect, values, kOption);
}

}  // namespace workbench::add
