// Windows together: inverse-variance weights by hand, and no window that disagrees.
#include "estimator/greybox/tracking/window_fusion.h"

#include <gtest/gtest.h>

namespace tracking = estimator::greybox::tracking;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using tracking::FusedEstimate;
using tracking::WindowFusion;

VectorXd one(double x) { return VectorXd::Constant(1, x); }
MatrixXd variance(double sd) { return MatrixXd::Constant(1, 1, sd * sd); }

TEST(WindowFusion, WeighsWindowsByTheirCovariance) {
  WindowFusion fusion(1, 2, 3);
  fusion.add(one(1.0), variance(1.0), true);
  fusion.add(one(50.0), variance(1.0), true);  // overlaps: not taken
  fusion.add(one(2.0), variance(2.0), true);
  const FusedEstimate fused = fusion.fused();
  EXPECT_EQ(fused.windows, 2);
  EXPECT_NEAR(fused.theta[0], (1.0 / 1.0 + 2.0 / 4.0) / (1.0 + 0.25), 1e-12);
  EXPECT_NEAR(fused.covariance(0, 0), 1.0 / 1.25, 1e-12);
}

TEST(WindowFusion, StopsAtAWindowThatDisagreesOrIsOfNoUse) {
  WindowFusion fusion(1, 1, 4);
  fusion.add(one(0.0), variance(1.0), true);
  fusion.add(one(10.0), variance(1.0), true);
  EXPECT_EQ(fusion.fused().windows, 1);
  EXPECT_NEAR(fusion.fused().theta[0], 10.0, 1e-12);
  fusion.add(one(10.5), variance(1.0), true);
  EXPECT_EQ(fusion.fused().windows, 2);
  fusion.add(one(10.5), variance(1.0), false);
  EXPECT_EQ(fusion.fused().windows, 0);
  fusion.add(one(11.0), variance(1.0), true);
  EXPECT_EQ(fusion.fused().windows, 1);
  fusion.clear();
  EXPECT_EQ(fusion.fused().windows, 0);
}

TEST(WindowFusion, TakesSoManyWindowsAtMost) {
  WindowFusion fusion(1, 1, 3);
  for (int k = 0; k < 7; ++k) fusion.add(one(k < 4 ? 0.0 : 1.0), variance(1.0), true);
  EXPECT_EQ(fusion.fused().windows, 3);
  EXPECT_NEAR(fusion.fused().theta[0], 1.0, 1e-12);
}

}  // namespace
