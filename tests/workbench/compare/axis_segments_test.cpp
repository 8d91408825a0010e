// A comparison of an axis whose segments begin in motion.
#include <gtest/gtest.h>

#include <cmath>

#include "estimator/greybox/validation/comparison.h"
#include "tests/estimator/greybox/axis_in_motion.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;
namespace {

using axis_in_motion::fast_axis;
using axis_in_motion::segments_in_motion;

TEST(SegmentsInMotion, LeaveTheGainThatAnAxisIsOffBy) {
  constexpr double kOff = 0.03;
  const validation::Comparison c = validation::compare(fast_axis(), segments_in_motion(1.0 + kOff));
  EXPECT_EQ(c.systematic.cause, validation::ErrorCause::gain);
  EXPECT_GT(c.systematic.share, 0.99);
  EXPECT_NEAR(c.systematic.gain_ratio, kOff, 0.002);
  EXPECT_NEAR(c.motion.ratio, 1.0 + kOff, 0.002);
  EXPECT_GT(c.motion.explained, 0.999);
}

// The second reading shows the speed: from there on the model has it.
TEST(SegmentsInMotion, LeaveNoSpeedErrorOnceTheSpeedIsFound) {
  const validation::Comparison c = validation::compare(fast_axis(), segments_in_motion(1.0));
  for (const std::size_t start : c.record.starts) {
    const double begins_mps = std::abs(c.speed_error_mps[start]);  // the model starts at rest
    if (begins_mps < 0.05) continue;
    EXPECT_LT(std::abs(c.speed_error_mps[start + 1]), 0.2 * begins_mps) << start;
  }
}

}  // namespace
}  // namespace workbench::compare
