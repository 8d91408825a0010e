#include "workbench/present/plot_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace workbench::present {
namespace {

using testing::Contains;
using testing::Each;
using testing::Lt;

constexpr std::size_t kRows = 120'000;
constexpr std::size_t kLimit = 20'000;

std::vector<double> wave(double turns) {
  std::vector<double> values(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    values[i] = std::sin(turns * 6.283185307 * static_cast<double>(i) / kRows);
  }
  return values;
}

TEST(Thin, ShortSeriesAreKeptWhole) {
  const std::vector<double> y{3.0, 1.0, 2.0};
  EXPECT_THAT(present::thin_lines({&y}, 3, 3), testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(present::thin_cloud(y, y, 3), testing::ElementsAre(0, 1, 2));
}

TEST(Thin, ASpikeOfOneSampleIsKeptInEverySeries) {
  std::vector<double> a = wave(3.0);
  std::vector<double> b = wave(5.0);
  a[70'001] = 9.0;
  b[11'117] = -9.0;
  const auto rows = present::thin_lines({&a, &b}, kRows, kLimit);
  EXPECT_THAT(rows, Contains(70'001));
  EXPECT_THAT(rows, Contains(11'117));
  EXPECT_LE(rows.size(), kLimit);
  EXPECT_GT(rows.size(), kLimit / 3);
}

TEST(Thin, RowsAscendAndRunFromFirstToLast) {
  const std::vector<double> y = wave(7.0);
  const auto rows = present::thin_lines({&y}, kRows, kLimit);
  EXPECT_EQ(rows.front(), 0U);
  EXPECT_EQ(rows.back(), kRows - 1);
  EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()), rows.end());
}

TEST(Thin, TheOutlineNeverFallsShortOfTheSeries) {
  // In every window of 1/1000 of the record the kept rows span what the record spans, but for the
  // part of a stretch that hangs over the window's ends: 20 samples of a wave of 3 turns.
  const double overhang = 3.0 * 6.3 * 20.0 / kRows;
  const std::vector<double> y = wave(3.0);
  const auto rows = present::thin_lines({&y}, kRows, kLimit);
  for (std::size_t window = 0; window < 1000; ++window) {
    const auto first = y.begin() + static_cast<long>(window * 120);
    const auto [low, high] = std::minmax_element(first, first + 120);
    double kept_low = 9.0;
    double kept_high = -9.0;
    for (const std::size_t row : rows) {
      if (row < window * 120 || row >= window * 120 + 120) continue;
      kept_low = std::min(kept_low, y[row]);
      kept_high = std::max(kept_high, y[row]);
    }
    ASSERT_LE(kept_low, *low + overhang);
    ASSERT_GE(kept_high, *high - overhang);
  }
}

TEST(Thin, AGapOfOneSampleStaysAGap) {
  std::vector<double> y = wave(3.0);
  y[50'003] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(present::thin_lines({&y}, kRows, kLimit), Contains(50'003));
}

TEST(Thin, ACloudKeepsItsExtremesAndDropsGaps) {
  std::vector<double> x = wave(11.0);
  std::vector<double> y = wave(4.0);
  y[33'333] = 5.0;
  y[44'444] = -5.0;
  for (std::size_t i = 60'000; i < 60'050; ++i) y[i] = std::nan("");
  x[9] = std::nan("");
  const auto rows = present::thin_cloud(x, y, 8000);
  EXPECT_LE(rows.size(), 8000U);
  EXPECT_GE(rows.size(), 7000U);
  EXPECT_THAT(rows, Contains(33'333));
  EXPECT_THAT(rows, Contains(44'444));
  EXPECT_THAT(rows, Each(Lt(kRows)));
  for (const std::size_t row : rows) ASSERT_TRUE(std::isfinite(x[row]) && std::isfinite(y[row]));
}

TEST(Thin, ACloudKeepsItsDensity) {
  // y is normal with deviation 1. An outline of 240 points a stretch reaches some 2.8; a sixteenth
  // of it raises the RMS of what is kept to sqrt(15/16 + 2.8^2/16) = 1.19.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> x(kRows), y(kRows);
  for (std::size_t i = 0; i < kRows; ++i) x[i] = static_cast<double>((i * 7919) % kRows) / kRows;
  for (double& value : y) value = normal(random);
  double sum = 0.0;
  std::vector<int> tenths(10);
  const auto rows = present::thin_cloud(x, y, 8000);
  for (const std::size_t row : rows) {
    sum += y[row] * y[row];
    ++tenths[static_cast<std::size_t>(x[row] * 10.0)];
  }
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(rows.size())), 1.19, 0.05);
  EXPECT_THAT(tenths, Each(testing::AllOf(testing::Gt(700), Lt(900))));
}

}  // namespace
}  // namespace workbench::present
