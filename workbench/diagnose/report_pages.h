// The report of a diagnosis: verdict and figures at the top, the falling error, the candidates of
// each round, the parameters, and each record held against the model before and after.
#pragma once

#include "workbench/diagnose/outcome.h"
#include "workbench/report/report.h"

namespace workbench::diagnose {

[[nodiscard]] report::Report report_of(const Outcome& outcome);

// Its parts.

[[nodiscard]] report::Section falling_error_section(const Outcome& outcome);
[[nodiscard]] report::Section candidates_section(const Outcome& outcome);
[[nodiscard]] report::Section parameters_section(const Outcome& outcome);
[[nodiscard]] report::Section where_section(const Outcome& outcome);
/// One section for each record.
[[nodiscard]] std::vector<report::Section> record_sections(const Outcome& outcome);

}  // namespace workbench::diagnose
