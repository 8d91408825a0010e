#include "workbench/serve/detectable.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/signals/nan.h"

namespace workbench::serve {
namespace {

using config::signals::kNaN;

TEST(DetectableChange, IsTheWayToTheEdgeOfTheBandAndTwoStandardErrorsMore) {
  const DetectableChange change = detectable_change(2.0, 0.05, 1.6, 2.6);
  EXPECT_DOUBLE_EQ(change.down_ratio, (0.4 + 0.1) / 2.0);
  EXPECT_DOUBLE_EQ(change.up_ratio, (0.6 + 0.1) / 2.0);
  const DetectableChange negative = detectable_change(-2.0, 0.0, -3.0, -1.0);
  EXPECT_DOUBLE_EQ(negative.down_ratio, 0.5);
  EXPECT_DOUBLE_EQ(negative.up_ratio, 0.5);
}

TEST(DetectableChange, IsNothingWithoutALimitAndZeroBeyondIt) {
  EXPECT_TRUE(std::isnan(detectable_change(2.0, 0.1, kNaN, 3.0).down_ratio));
  EXPECT_TRUE(std::isnan(detectable_change(kNaN, 0.1, 1.0, 3.0).up_ratio));
  EXPECT_EQ(detectable_change(4.0, 0.1, 1.0, 3.0).up_ratio, 0.0);
  EXPECT_DOUBLE_EQ(detectable_change(2.0, kNaN, 1.0, 3.0).up_ratio, 0.5);
}

}  // namespace
}  // namespace workbench::serve
