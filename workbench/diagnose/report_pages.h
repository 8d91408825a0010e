// The report of a diagnosis: verdict and figures at the top, the falling error, the candidates of
// each round, the parameters, and each record held against the model before and after.
#pragma once

#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

[[nodiscard]] present::Report report_of(const DiagnosisReport& outcome);

// Its parts.

[[nodiscard]] present::Section falling_error_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section candidates_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section parameters_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section where_section(const DiagnosisReport& outcome);
/// One section for each record.
[[nodiscard]] std::vector<present::Section> record_sections(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
