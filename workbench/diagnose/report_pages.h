// The report of a diagnosis: verdict and figures at the top, the falling error, the candidates of
// each round, the parameters, and each record held against the model before and after.
#pragma once

#include "workbench/diagnose/outcome.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

[[nodiscard]] present::Report report_of(const Outcome& outcome);

// Its parts.

[[nodiscard]] present::Section falling_error_section(const Outcome& outcome);
[[nodiscard]] present::Section candidates_section(const Outcome& outcome);
[[nodiscard]] present::Section parameters_section(const Outcome& outcome);
[[nodiscard]] present::Section where_section(const Outcome& outcome);
/// One section for each record.
[[nodiscard]] std::vector<present::Section> record_sections(const Outcome& outcome);

}  // namespace workbench::diagnose
