// The better model's file: the model as text, and at its top what was changed and why.
#pragma once

#include <string>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// With nothing missing it is the given model with its fitted parameters. Outcome::fitted() must
/// hold.
[[nodiscard]] std::string better_model_text(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
