// Windows together: inverse-variance weights by hand, and no window that disagrees.
#include "estimator/greybox/tracking/window_fusion.h"

#include <gtest/gtest.h>

namespace tracking = estimator::greybox::tracking;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using tracking::Pool;
using tracking::Pooled;

VectorXd one(double x) { return VectorXd::Constant(1, x); }
MatrixXd variance(double sd) { return MatrixXd::Constant(1, 1, sd * sd); }

TEST(Pool, WeighsWindowsByTheirCovariance) {
  Pool pool(1, 2, 3);
  pool.add(one(1.0), variance(1.0), true);
  pool.add(one(50.0), variance(1.0), true);  // overlaps: not taken
  pool.add(one(2.0), variance(2.0), true);
  const Pooled pooled = pool.pooled();
  EXPECT_EQ(pooled.windows, 2);
  EXPECT_NEAR(pooled.x[0], (1.0 / 1.0 + 2.0 / 4.0) / (1.0 + 0.25), 1e-12);
  EXPECT_NEAR(pooled.covariance(0, 0), 1.0 / 1.25, 1e-12);
}

TEST(Pool, StopsAtAWindowThatDisagreesOrIsOfNoUse) {
  Pool pool(1, 1, 4);
  pool.add(one(0.0), variance(1.0), true);
  pool.add(one(10.0), variance(1.0), true);
  EXPECT_EQ(pool.pooled().windows, 1);
  EXPECT_NEAR(pool.pooled().x[0], 10.0, 1e-12);
  pool.add(one(10.5), variance(1.0), true);
  EXPECT_EQ(pool.pooled().windows, 2);
  pool.add(one(10.5), variance(1.0), false);
  EXPECT_EQ(pool.pooled().windows, 0);
  pool.add(one(11.0), variance(1.0), true);
  EXPECT_EQ(pool.pooled().windows, 1);
  pool.clear();
  EXPECT_EQ(pool.pooled().windows, 0);
}

TEST(Pool, TakesSoManyWindowsAtMost) {
  Pool pool(1, 1, 3);
  for (int k = 0; k < 7; ++k) pool.add(one(k < 4 ? 0.0 : 1.0), variance(1.0), true);
  EXPECT_EQ(pool.pooled().windows, 3);
  EXPECT_NEAR(pool.pooled().x[0], 1.0, 1e-12);
}

}  // namespace
