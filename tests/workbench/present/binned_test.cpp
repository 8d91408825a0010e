#include "workbench/present/record_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace workbench::present {
namespace {

TEST(Binned, MeanAndRmsOfEveryStretchAreThoseOfItsPoints) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 100; ++i) {  // -3 and +5 in turn below 50, all 2 above
    x.push_back(i);
    y.push_back(i >= 50 ? 2.0 : i % 2 == 0 ? -3.0 : 5.0);
  }
  y[10] = std::numeric_limits<double>::quiet_NaN();
  y[11] = std::numeric_limits<double>::infinity();
  const present::Binned b = present::binned(x, y, 2);
  ASSERT_EQ(b.mean.y.size(), 2U);
  EXPECT_DOUBLE_EQ(b.mean.x[0], 24.75);  // of 0 to 99 in two
  EXPECT_DOUBLE_EQ(b.mean.y[0], 1.0);
  EXPECT_DOUBLE_EQ(b.rms.y[0], std::sqrt(17.0));
  EXPECT_DOUBLE_EQ(b.mean.y[1], 2.0);
  EXPECT_DOUBLE_EQ(b.rms.y[1], 2.0);
}

TEST(Binned, StretchesOfFewPointsAreLeftOutAndOneXHasNone) {
  const std::vector<double> x{0, 0, 0, 0, 0, 10, 10, 10, 10};
  EXPECT_EQ(present::binned(x, std::vector<double>(9, 1.0), 10).mean.x.size(), 1U);
  EXPECT_TRUE(present::binned(std::vector<double>(9, 1.0), x).mean.x.empty());
}

}  // namespace
}  // namespace workbench::present
