// A diagnosis in sentences.
#pragma once

#include <string>
#include <vector>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// One paragraph each: fall of the error, rivals, site of the remaining error, advice.
[[nodiscard]] std::vector<std::string> remarks(const DiagnosisReport& outcome);

/// Time by which the better model's command acts before it is logged; below 0: after.
[[nodiscard]] double advanced_s(const DiagnosisReport& outcome);

/// Command that follows; empty where there is none.
[[nodiscard]] std::string next_command(const DiagnosisReport& outcome);

/// "every other 2 s is fitted, the rest scores", ...
[[nodiscard]] std::string split_words(const DiagnosisReport& outcome);

/// "model file as it is", "+ friction", ...
struct StepWords {
  std::string what;
  double rms_m = 0.0;
};
[[nodiscard]] std::vector<StepWords> step_words(const selection::Diagnosis& diagnosis);
/// The errors below which a model of the command cannot come, the largest first.
[[nodiscard]] std::vector<StepWords> floor_steps(const selection::Diagnosis& d);

/// The path without its folders.
[[nodiscard]] std::string file_name(const std::string& file);

/// True for a parameter of what was found missing; of an effect that the file has, what it lacks.
[[nodiscard]] bool was_added(const selection::Diagnosis& diagnosis,
                             const selection::ParameterValue& parameter);

}  // namespace workbench::diagnose
