// A diagnosis as text for a terminal: words first, then the figures.
#pragma once

#include <iosfwd>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

void print(const DiagnosisReport& outcome, std::ostream& out);

}  // namespace workbench::diagnose
