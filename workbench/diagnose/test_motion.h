// Motions that a test stand could be asked to run, and the record that a model would give on them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/control/reference.h"
#include "estimator/greybox/selection/problem.h"
#include "plant_sim/model_file.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

struct TestMotion {
  monitor::control::ReferenceConfig reference;
  double duration_s = 30.0;
  std::string words;  ///< "a multisine of 0.1 to 1.9 Hz within 38 mm of 305 mm for 30 s"
};

/// Sines, multisines, steps, chirp and random binary motions about where the records move, up to
/// half as far again or a tenth of the stroke either way, within the stroke; without a motion in
/// the records, about the middle of the stroke.
[[nodiscard]] std::vector<TestMotion> test_motions(const selection::DiagnosisProblem& problem);

/// The model's record in closed loop with its own gain, a 12-bit D/A and the records' encoder and
/// noise. None when the rod does not follow: the command saturates, or the numbers end.
[[nodiscard]] std::optional<greybox::Dataset> simulated(const selection::DiagnosisProblem& problem,
                                                        plant_sim::ModelFile model,
                                                        const TestMotion& motion,
                                                        std::uint64_t seed);

}  // namespace workbench::diagnose
