// The next experiment when a record does not answer the question: the motion or the sensor that
// would.
//
// Rivals explain a record about as well. On each motion that might separate them every rival in
// turn is taken for the truth, simulated in closed loop, and the found effect and the others are
// adjusted to it: the motion on which even the closest of the others stays furthest from the found
// effect is advised.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/problem.h"
#include "workbench/diagnose/test_motion.h"

namespace workbench::diagnose {

/// Error of a wrong explanation, over the noise, from which a motion separates two.
inline constexpr double kSeparates = 1.15;

struct Advice {
  bool separates = false;   ///< false: no motion tried separates the rivals
  double separation = 1.0;  ///< error of the nearest wrong explanation over the noise
  TestMotion motion;        ///< the best one
  std::string words;
};

/// `names` of the rivals, one for each, the found effect first. At least two rivals.
[[nodiscard]] Advice advise(const selection::SearchContext& context,
                            const std::vector<greybox::FitSummary>& rivals,
                            const std::vector<std::string>& names);

/// For a record that does not move enough.
[[nodiscard]] std::string advice_to_excite(const selection::DiagnosisProblem& problem);

/// For a residual that no effect explains; `where` as localise() gives it, may be empty.
[[nodiscard]] std::string advice_for_unexplained(const std::vector<selection::Localisation>& where,
                                                 const std::string& plant = "hydraulic_actuator");

struct AdvisedDiagnosis {
  selection::Diagnosis diagnosis;
  std::string advice;  ///< "" where nothing is left to ask
};

/// selection::diagnose() with the advice that follows from it.
[[nodiscard]] AdvisedDiagnosis diagnose(const selection::DiagnosisProblem& problem,
                                        selection::DiagnosisOptions options);

}  // namespace workbench::diagnose
