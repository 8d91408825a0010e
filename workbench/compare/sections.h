// A comparison as a report: what `spoolwatch compare --report` writes, and the sections that any
// report on a model against a measurement shares.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/validation/comparison.h"
#include "workbench/present/report.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;

/// Over time; where it arises; against each variable; how it was computed. `prefix` keeps the zoom
/// groups of several comparisons in one report apart.
[[nodiscard]] std::vector<present::Section> sections(const validation::Comparison& comparison,
                                                     const std::string& prefix = "");

[[nodiscard]] present::Report make_report(const validation::Comparison& comparison,
                                          const std::string& command);

}  // namespace workbench::compare
