// Sections of the HTML report of a diagnosis.
#pragma once

#include <optional>
#include <vector>

#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

[[nodiscard]] present::Section falling_error_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section candidates_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section parameters_section(const DiagnosisReport& outcome);
[[nodiscard]] present::Section where_section(const DiagnosisReport& outcome);
/// The laws that were learned, as curves; at least one.
[[nodiscard]] present::Section laws_section(const DiagnosisReport& outcome);
/// The part that each step takes away; none for fewer than two steps.
[[nodiscard]] std::optional<present::Section> steps_section(const DiagnosisReport& outcome);
/// One section for each record.
[[nodiscard]] std::vector<present::Section> record_sections(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
