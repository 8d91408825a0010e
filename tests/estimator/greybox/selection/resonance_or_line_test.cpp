// A resonance at the frequency of a spectral line is that line where it hardly damps, and a part
// that swings where it does.
#include "estimator/greybox/selection/resonance_or_line.h"

#include <gtest/gtest.h>

namespace estimator::greybox::selection {
namespace {

/// True where a second mass of 22.5 Hz is taken for a line.
bool is_taken_for_line(double damping_ratio, double line_Hz) {
  InnovationStage stage;
  stage.noise.lines.push_back({});
  stage.noise.lines.back().frequency_Hz = line_Hz;
  FreeParameter frequency;
  frequency.name = "second_mass.resonance_Hz";
  frequency.unit = 22.5;
  FreeParameter damping;
  damping.name = "second_mass.damping_ratio";
  damping.unit = damping_ratio;
  stage.model.added = {"second_mass"};
  stage.model.fitted.parameters = {frequency, damping};
  stage.model.fitted.theta = Eigen::VectorXd::Ones(2);
  return rings_with_a_line(stage, frequency, 1.0);
}

TEST(ResonanceOrLine, OneThatHardlyDampsIsTheLineAtItsFrequency) {
  EXPECT_TRUE(is_taken_for_line(0.005, 23.0));
  EXPECT_FALSE(is_taken_for_line(0.005, 30.0));
}

TEST(ResonanceOrLine, OneThatDampsIsNoLine) { EXPECT_FALSE(is_taken_for_line(0.05, 23.0)); }

}  // namespace
}  // namespace estimator::greybox::selection
