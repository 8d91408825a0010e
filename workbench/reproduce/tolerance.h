// When a figure counts as reproduced: one rule for each kind of figure, each with its reason. All
// rules are in one table (tolerance.cpp), so that they can be judged together.
#pragma once

#include <string>
#include <string_view>

#include "workbench/reproduce/row.h"

namespace workbench::reproduce {

enum class Rule {
  relative,  ///< |ours - printed| <= low |printed|
  interval,  ///< low <= ours <= high
  apart,     ///< low <= ours - printed <= high
  same,      ///< the same words
  none,      ///< not judged: "n.a."
};

struct Tolerance {
  std::string_view name;
  Rule rule;
  bool expected;  ///< rows judged by it are meant to agree
  double low;
  double high;
  std::string_view reason;
};

/// Asserts that there is such a rule.
[[nodiscard]] const Tolerance& tolerance(std::string_view name);

/// A row judged by the rule of that name; a missing value, or one that is not finite, never agrees.
[[nodiscard]] ReproducedRow judged(std::string what, Value printed, Value ours,
                                   std::string_view rule, std::string note = "");

}  // namespace workbench::reproduce
