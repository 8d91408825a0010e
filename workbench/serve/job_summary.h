// What a fit or a diagnosis has found, as the page shows it: words, steps, candidates, learned
// laws.
#pragma once

#include <nlohmann/json.hpp>

#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/fit/fit_report.h"

namespace workbench::serve {

// In the units of the axis that is printed.

[[nodiscard]] nlohmann::ordered_json summary_of(const diagnose::DiagnosisReport& report);
[[nodiscard]] nlohmann::ordered_json summary_of(const fit::FitReport& report);

}  // namespace workbench::serve
