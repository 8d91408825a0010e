// Effects whose values are at the bound of what they can be.
#include "estimator/greybox/selection/parameter_subset.h"

#include <gtest/gtest.h>

namespace estimator::greybox::selection {
namespace {

/// A resonance of the given size and damping, either of which may be at its bound.
FitSummary resonance(double mass_ratio, int mass_bound, double damping_ratio, int damping_bound) {
  FitSummary fitted;
  fitted.parameters.resize(2);
  fitted.parameters[0].name = "second_mass.mass_ratio";
  fitted.parameters[1].name = "second_mass.damping_ratio";
  fitted.theta = Eigen::Vector2d(mass_ratio, damping_ratio);
  fitted.at_bound = {mass_bound, damping_bound};
  return fitted;
}

TEST(LeavesItsRange, AResonanceWithoutDampingStandsForSomethingElse) {
  EXPECT_FALSE(leaves_its_range(resonance(0.2, 0, 0.03, 0), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.2, 0, 0.0, -1), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.2, 0, 1e-5, 0), 0));
  EXPECT_TRUE(leaves_its_range(resonance(0.95, 1, 0.03, 0), 0));
  EXPECT_FALSE(leaves_its_range(resonance(0.0, -1, 0.03, 0), 0));  // absent
}

}  // namespace
}  // namespace estimator::greybox::selection
