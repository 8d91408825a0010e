// Laws that a diagnosis has learned, with their values and their curves.
#pragma once

#include <vector>

#include "estimator/greybox/law_curve.h"
#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

struct LearnedLaw {
  const selection::Law* law = nullptr;
  std::vector<selection::ParameterValue> parameters;  ///< in the order of the formula's own
  estimator::greybox::LawCurve curve;
};

/// One per law, in the order added. `outcome` must outlive them.
[[nodiscard]] std::vector<LearnedLaw> learned_laws(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
