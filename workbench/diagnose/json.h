// A diagnosis as JSON, SI throughout; missing numbers are null.
#pragma once

#include <string>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

[[nodiscard]] std::string to_json(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
