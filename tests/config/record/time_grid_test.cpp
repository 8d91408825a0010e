// The grid of a record's samples, from times that are rounded, jitter, or share the ticks of a
// coarse clock, and readings that no motion has made.
#include "config/record/time_grid.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "config/record/outliers.h"
#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using record_test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(TimeGrid, OfRoundedTimesIsTheNominalOne) {
  std::vector<double> t_s;
  for (int k = 0; k < 1000; ++k) t_s.push_back(std::round(1000.0 * k / 300.0) / 1000.0);
  const auto grid = find_nominal_grid(t_s);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(1.0 / grid->grid.sample_time_s, 300.0, 0.01);
  EXPECT_TRUE(grid->grid.gaps.empty());
  EXPECT_LT(grid->largest_error_s, 0.6e-3);
}

TEST(TimeGrid, OfJitteringTimesKeepsTheirGaps) {
  std::mt19937 random(3);
  std::normal_distribution<double> jitter(0.0, 0.0005);
  std::vector<double> t_s;
  for (int k = 0; k < 1000; ++k) {
    if (k < 400 || k >= 437) t_s.push_back(k * 0.005 + jitter(random));
  }
  const auto grid = find_nominal_grid(t_s);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->grid.sample_time_s, 0.005, 1e-6);
  EXPECT_THAT(grid->grid.gaps, ElementsAre(400U));
  EXPECT_NEAR(grid->t_s[400] - grid->t_s[399], 38 * 0.005, 1e-5);
}

TEST(TimeGrid, OfRowsThatShareTicksIsCountedOverWholeTicks) {
  const auto ticking = [](int rows, double tick_s, double begin_s) {
    std::vector<double> t_s;
    for (int k = 0; k < rows; ++k) {
      t_s.push_back(std::floor((k / 200.0 + begin_s) / tick_s + 1e-9) * tick_s);
    }
    return find_nominal_grid(t_s);
  };
  for (const double begin_s : {0.0, 0.033, 0.07}) {
    const auto grid = ticking(500, 0.1, begin_s);
    ASSERT_TRUE(grid) << begin_s;
    EXPECT_NEAR(grid->grid.sample_time_s, 0.005, 1e-9) << begin_s;
  }
  EXPECT_FALSE(ticking(500, 1.0, 0.3));               // 200 rows within whole ticks
  const auto beating = ticking(2000, 0.015625, 0.0);  // 3.125 rows a tick
  ASSERT_TRUE(beating);
  EXPECT_NEAR(beating->grid.sample_time_s, 0.005, 0.005 * 0.0025);
}

/// 4000 rows at 200 Hz without `lost` of them, with times in whole ticks.
std::vector<double> ticking_with_loss(double tick_s, int lost) {
  std::vector<double> t_s;
  for (int k = 0; k < 4000; ++k) {
    if (k < 705 || k >= 705 + lost) t_s.push_back(std::floor(k / 200.0 / tick_s + 1e-9) * tick_s);
  }
  return t_s;
}

TEST(TimeGrid, IsNoneWhereRowsAreLostWithinATick) {
  for (const int lost : {5, 20, 60}) {
    const std::vector<double> t_s = ticking_with_loss(1.0, lost);
    EXPECT_FALSE(find_nominal_grid(t_s)) << lost;
    const auto odd = find_uneven_tick(t_s);
    ASSERT_TRUE(odd) << lost;
    EXPECT_EQ(odd->first, 600U);
    EXPECT_EQ(odd->samples, 200U - static_cast<unsigned>(lost));
    EXPECT_EQ(odd->usual, 200U);
  }
  EXPECT_FALSE(find_uneven_tick(ticking_with_loss(1.0, 1)));  // as the beat of another rate
  // Whole ticks are lost too: a gap.
  const auto gap = find_nominal_grid(ticking_with_loss(0.1, 60));
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->grid.sample_time_s, 0.005, 1e-9);
  EXPECT_EQ(gap->grid.gaps.size(), 1U);
}

/// A file of one row for each time.
std::string file_at(const std::vector<double>& t_s) {
  std::string text = "t_s,u_V,y_m\n";
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    text += std::to_string(t_s[i]) + "," + std::to_string(i % 7) + ",0.1\n";
  }
  return text;
}

TEST(TimeGrid, OfACoarseClockIsRefusedByTheTickThatLacksRows) {
  EXPECT_THAT(error_of(file_at(ticking_with_loss(1.0, 60))),
              HasSubstr(":602: 140 rows between 3 s and 4 s, 200 elsewhere"));
}

TEST(TimeGrid, IsCalledCoarseWhereTicksAreSharedAlone) {
  std::vector<double> doubled;
  for (int k = 0; k < 200; ++k) doubled.push_back(0.005 * (k < 50 ? k : k - 1));
  const std::vector<double> short_one(doubled.begin() + 40, doubled.begin() + 52);
  for (const std::vector<double>& t_s : {doubled, short_one, {0.0}, {0.0, 0.0}}) {
    EXPECT_THAT(error_of(file_at(t_s)), Not(HasSubstr("coarse"))) << t_s.size();
  }
  std::vector<double> coarse;
  for (int k = 0; k < 300; ++k) coarse.push_back(std::floor(k / 200.0));
  EXPECT_THAT(error_of(file_at(coarse)),
              HasSubstr("too coarse to tell the rate; state it with --map t=RATEHz, which takes "
                        "the rows as they follow"));
}

TEST(TimeGrid, IsNoneForTimesThatDriftOrAreLostInAPattern) {
  std::vector<double> swept;
  std::vector<double> lost;
  for (int k = 0; k < 600; ++k) {
    swept.push_back(0.005 * k + 1e-5 * k * k);
    if (k % 3 != 2) lost.push_back(0.005 * k);
  }
  EXPECT_FALSE(find_nominal_grid(swept));
  EXPECT_FALSE(find_nominal_grid(lost));
}

TEST(Outliers, AreSingleReadingsFarOffAndNoStepsOrNoise) {
  std::vector<double> values;
  values.reserve(2000);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-5);
  for (int k = 0; k < 2000; ++k) {
    values.push_back((k / 500 % 2 == 0 ? 0.2 : 0.3) + 0.01 * std::sin(0.01 * k) + noise(random));
  }
  EXPECT_TRUE(find_outliers(values, {}).empty());
  values[123] = 9.99;
  values[1500] = 0.0;
  EXPECT_THAT(find_outliers(values, {}), ElementsAre(123U, 1500U));
}

}  // namespace
}  // namespace config::record
