// A diagnosis held against what a record is known to hide.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/truth/case.h"
#include "workbench/diagnose/experiment_design.h"

namespace diagnose_test {

namespace selection = estimator::greybox::selection;

/// Held-out error over the noise floor that a found model may leave.
inline constexpr double kAtFloor = 1.1;
/// How many of its standard errors a value may be off.
inline constexpr double kStdErrors = 3.0;
/// Held-out error over the noise floor up to which a hidden effect need not be seen.
inline constexpr double kVisible = 1.5;

inline selection::Diagnosis found_in(const selection::SearchContext& context) {
  return workbench::diagnose::diagnose(context.problem, context.options).diagnosis;
}

inline std::string said(const selection::Diagnosis& d) {
  std::string words = selection::to_string(d.verdict);
  for (const std::string& name : d.missing) words += " " + name;
  for (const auto& group : d.ambiguous) {
    words += " {";
    for (const std::string& name : group) words += " " + name;
    words += " }";
  }
  words += ", error / floor " + std::to_string(d.rms_before_m / d.noise_floor_m) + " -> " +
           std::to_string(d.rms_after_m / d.noise_floor_m);
  for (const auto& where : d.where) words += ", " + where.site + "/" + where.variable;
  return words;
}

/// Named exactly; or with at most two others that it cannot be told from; or not to be seen.
inline bool is_right(const selection::Diagnosis& d, const std::vector<std::string>& hidden) {
  using selection::Verdict;
  if (d.verdict == Verdict::missing) {
    return std::is_permutation(d.missing.begin(), d.missing.end(), hidden.begin(), hidden.end());
  }
  if (d.verdict == Verdict::undetermined && hidden.size() == 1) {
    return d.missing.size() == 1 &&
           std::any_of(d.ambiguous.begin(), d.ambiguous.end(), [&](const auto& group) {
             return group.size() <= 3 &&
                    std::find(group.begin(), group.end(), hidden.front()) != group.end();
           });
  }
  return d.verdict == Verdict::nothing_missing && d.rms_before_m < kVisible * d.noise_floor_m;
}

/// Every scored parameter of the hidden effects is within its tolerance, or within a few of its own
/// standard errors.
inline void expect_values(const selection::Diagnosis& d, const truth::Case& of) {
  const std::vector<std::string> hidden = truth::hidden_effects(of.hidden);
  for (const truth::Parameter& parameter : truth::parameters()) {
    if (parameter.tolerance == 0.0 ||
        std::find(hidden.begin(), hidden.end(), parameter.effect) == hidden.end()) {
      continue;
    }
    const std::string name = parameter.effect + "." + parameter.name;
    const auto found = std::find_if(d.parameters.begin(), d.parameters.end(),
                                    [&](const auto& value) { return value.name == name; });
    ASSERT_NE(found, d.parameters.end()) << name;
    const double truth = of.hidden.*parameter.member;
    const double error = std::isnan(found->std_error) ? 0.0 : found->std_error;
    EXPECT_LE(std::abs(found->value - truth),
              std::max(parameter.tolerance * std::abs(truth), kStdErrors * error))
        << name << " is " << truth << ", found " << found->value << " +- " << found->std_error;
  }
}

}  // namespace diagnose_test
