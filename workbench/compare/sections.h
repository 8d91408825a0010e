// A comparison as a report: what `spoolwatch compare --report` writes, and the sections that any
// report on a model against a measurement shares.
#pragma once

#include <string>
#include <vector>

#include "workbench/compare/comparison.h"
#include "workbench/report/report.h"

namespace workbench::compare {

/// Over time; where it arises; against each variable; how it was computed. `prefix` keeps the zoom
/// groups of several comparisons in one report apart.
[[nodiscard]] std::vector<report::Section> sections(const Comparison& comparison,
                                                    const std::string& prefix = "");

[[nodiscard]] report::Report make_report(const Comparison& comparison, const std::string& command);

}  // namespace workbench::compare
