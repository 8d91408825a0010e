// Sentences on rivals: other causes that would explain a record as well as the effects found.
#pragma once

#include <string>
#include <vector>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

/// "a or b; c or d": the groups that the motion cannot tell apart.
[[nodiscard]] std::string groups_words(const selection::Diagnosis& d);

/// A sentence for each kind of rival: groups, a held pressure, a lag of the sensor.
[[nodiscard]] std::vector<std::string> rival_words(const selection::Diagnosis& d);

}  // namespace workbench::diagnose
