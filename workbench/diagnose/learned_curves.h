// Laws that a diagnosis has learned, with their values and their curves.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/law_curve.h"
#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

struct LearnedLaw {
  const selection::Law* law = nullptr;
  std::vector<selection::ParameterValue> parameters;  ///< in the order of the formula's own
  estimator::greybox::LawCurve curve;
};

/// The axes of a law's curve as a page prints them, in units without the "m" of an axis that turns.
struct LawAxes {
  std::string x_name, x_unit;  ///< `x` times x_per is in it
  double x_per = 1.0;
  std::string y_name, y_unit;
  std::string held;  ///< "Drawn for 12 mm of y_m."; empty: the law depends on one variable alone
};
[[nodiscard]] LawAxes axes_of(const estimator::greybox::LawCurve& curve);

/// One per law, in the order added. `outcome` must outlive them.
[[nodiscard]] std::vector<LearnedLaw> learned_laws(const DiagnosisReport& outcome);

}  // namespace workbench::diagnose
