#include "estimator/greybox/selection/packed_linearisation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace estimator::greybox::selection {
namespace {

using disturbance::Linearisation;
using disturbance::StateMatrix;
using disturbance::StateVector;

/// Two entries of the transition change, one of them from 0 to -0.
Linearisation some_linearisation() {
  Linearisation linear;
  linear.states = {"y_m", "v_mps"};
  linear.force = true;
  linear.force_place = 0.25;
  for (int k = 0; k < 5; ++k) {
    StateMatrix a = StateMatrix::Zero();
    a(0, 0) = 1.0;
    a(0, 1) = 0.005;
    a(1, 1) = 1.0 - 1e-3 * k;
    a(1, 6) = k == 3 ? -0.0 : 0.0;
    linear.transition.push_back(a);
    linear.from_supply.emplace_back(StateVector::Constant(k == 4 ? 2.0 : 1.0));
    linear.speed_mps.push_back(0.1 * k);
  }
  linear.gap_m = {1e-6, -1e-6};
  return linear;
}

TEST(PackedLinearisation, UnpacksToTheSameBits) {
  const Linearisation linear = some_linearisation();
  const PackedLinearisation packed(linear);
  const Linearisation again = packed.unpacked();
  EXPECT_EQ(again.states, linear.states);
  EXPECT_EQ(again.force, linear.force);
  EXPECT_EQ(again.force_place, linear.force_place);
  EXPECT_EQ(again.speed_mps, linear.speed_mps);
  EXPECT_EQ(again.gap_m, linear.gap_m);
  ASSERT_EQ(again.transition.size(), linear.transition.size());
  ASSERT_EQ(again.from_supply.size(), linear.from_supply.size());
  for (std::size_t k = 0; k < linear.transition.size(); ++k) {
    EXPECT_EQ(again.transition[k], linear.transition[k]);
    EXPECT_EQ(again.from_supply[k], linear.from_supply[k]);
  }
  EXPECT_TRUE(std::signbit(again.transition[3](1, 6)));
  EXPECT_FALSE(std::signbit(again.transition[2](1, 6)));
}

TEST(PackedLinearisation, TakesOneNumberForAnEntryThatStays) {
  const Linearisation linear = some_linearisation();
  // 47 entries stay and 2 change; the 7 of the supply change
  EXPECT_EQ(PackedLinearisation(linear).size_bytes(),
            sizeof(double) * (47 + 2 * 5 + 7 * 5 + 5 + 2));
}

TEST(PackedLinearisation, OneWithoutSamplesStaysEmpty) {
  const Linearisation again = PackedLinearisation(Linearisation{}).unpacked();
  EXPECT_TRUE(again.transition.empty());
  EXPECT_TRUE(again.from_supply.empty());
}

}  // namespace
}  // namespace estimator::greybox::selection
