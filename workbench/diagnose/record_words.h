// The sentences of a diagnosis on the records themselves: what they leave out, how they were
// misread.
#pragma once

#include <string>
#include <vector>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// "the rod moves by 0.01 mm in all, 0.001 mm of it noise"
[[nodiscard]] std::string excitation_words(const selection::Excitation& excitation);

/// A quarter of the better model's step, s, as --set takes it.
[[nodiscard]] std::string finer_step_words(const selection::Diagnosis& diagnosis);

/// Restrictions: gaps of the records, long records, interruption.
[[nodiscard]] std::vector<std::string> notes(const DiagnosisReport& outcome);

/// Sign, clocks, sizes and stroke of the records, and a plant that fits them better.
[[nodiscard]] std::vector<std::string> record_remarks(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
