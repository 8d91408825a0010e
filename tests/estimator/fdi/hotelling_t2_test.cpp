// Distance from a healthy region, slow trends.
#include "estimator/fdi/hotelling_t2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimator/fdi/trend.h"
#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

using fdi_test::PlainValues;
using fdi_test::refusal;

TEST(HotellingT2, MeasuresTheDistanceInItsOwnSpreadAndNamesTheValueItComesFrom) {
  // S = [4 3; 3 9], S^-1 = [9 -3; -3 4]/27. x - mean = (2, -3): T^2 = (36 + 36 + 36)/27 = 4.
  const double mean[] = {10.0, 20.0};
  const double covariance[] = {4.0, 3.0, 3.0, 9.0};
  HotellingT2 region(mean, covariance, 100.0, "here");
  const double x[] = {12.0, 17.0};
  EXPECT_NEAR(region.statistic(x), 4.0, 1e-6);
  // Given the other: x1 | x2 has mean 10 + 3/9 (-3) = 9 and variance 3, (12 - 9)^2/3 = 3;
  // x2 | x1: 20 + 3/4 2 = 21.5 and 6.75, 4.5^2/6.75 = 3. A step in x2 alone is x2's.
  const double y[] = {10.0, 26.0};
  EXPECT_NEAR(region.statistic(y), 4.0 * 36.0 / 27.0, 1e-6);
  EXPECT_EQ(region.main_contributor(), 1U);
  // d (n + 1)(n - 1)/(n (n - d)) F(p; d, n - d) with n = 52: 2*53*51/(52*50) * 5.056610865
  HotellingT2 few(mean, covariance, 52.0, "here");
  EXPECT_NEAR(few.limit(0.01), 2.0 * 53.0 * 51.0 / (52.0 * 50.0) * 5.056610865, 1e-6);
}

TEST(HotellingT2, SayHowOftenAHealthyBlockIsOutside) {
  // Mean and covariance from 20 blocks each time: chi-square would be exceeded by 4.6 %, not 1 %.
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  constexpr int kBlocks = 20;
  constexpr int kRuns = 20000;
  int outside = 0;
  for (int run = 0; run < kRuns; ++run) {
    double x[kBlocks + 1][2];
    double mean[2] = {};
    double s[4] = {};
    for (auto& row : x) {
      row[0] = 1e-4 * normal(random);
      row[1] = 300.0 * normal(random) + 1e6 * row[0];
    }
    for (int i = 0; i < kBlocks; ++i) {
      for (int j = 0; j < 2; ++j) mean[j] += x[i][j] / kBlocks;
    }
    for (int i = 0; i < kBlocks; ++i) {
      for (int j = 0; j < 4; ++j) {
        s[j] += (x[i][j / 2] - mean[j / 2]) * (x[i][j % 2] - mean[j % 2]) / (kBlocks - 1);
      }
    }
    HotellingT2 region(mean, s, kBlocks, "here");
    outside += region.statistic(x[kBlocks]) > region.limit(0.01) ? 1 : 0;
  }
  EXPECT_NEAR(outside, 0.01 * kRuns, 4.0 * std::sqrt(0.01 * kRuns));
}

const char* const kDistance =
    "[[distance]]\nid = 'd'\nfeatures = ['sample.y_m', 'sample.u_V']\nfalse_alarm_time_s = 1e4\n"
    "[distance.healthy]\nname = 'healthy'\nblocks = 1000\nmean = [10.0, 20.0]\n"
    "covariance = [4.0, 3.0, 3.0, 9.0]\nlong_run = [2.0, 3.0]\n";

TEST(Distance, SeesACombinationThatNoBandSees) {
  PlainValues values(kDistance);
  values.feed(13.0, 24.5);
  EXPECT_TRUE(values.alarms.empty()) << "1.5 standard deviations each, the way they go together";
  values.feed(14.0, 11.0);  // 2 and 3 the other way: T^2 = (9*16 + 6*36 + 4*81)/27 = 25.3
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_NEAR(values.last("distance2"), 684.0 / 27.0, 1e-5);
  EXPECT_NE(values.alarms[0].reason.find("most by sample.u_V"), std::string::npos)
      << values.alarms[0].reason;
  values.feed(10.0, 20.0);
  EXPECT_EQ(values.alarms.back().severity, Severity::ok);
}

TEST(Distance, IsRefusedUntrainedOrWithAFlatRegion) {
  EXPECT_NE(refusal("[[distance]]\nid = 'd'\nfeatures = ['sample.y_m']\n").find("not trained"),
            std::string::npos);
  std::string flat = kDistance;
  flat.replace(flat.find("4.0, 3.0, 3.0, 9.0"), 18, "4.0, 9.0, 9.0, 9.0");
  EXPECT_NE(refusal(flat).find("positive definite"), std::string::npos);
}

TEST(LocalTrend, IsTheStraightLineOfLeastSquaresWhenNothingIsForgotten) {
  // n points at unit steps: var slope = 12 s^2/(n (n^2 - 1)), var of the line's end
  // 2 s^2 (2 n - 1)/(n (n + 1)).
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0.0, 0.5);
  LocalTrend trend(0.5, 0.0);
  constexpr int kPoints = 40;
  double sy = 0.0;
  double sty = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double y = 3.0 + 0.1 * i + normal(random);
    trend.add(y, 1.0);
    sy += y;
    sty += i * y;
  }
  constexpr double n = kPoints;
  const double slope = (12.0 * sty - 6.0 * (n - 1.0) * sy) / (n * (n * n - 1.0));
  const double end = sy / n + slope * (n - 1.0) / 2.0;
  EXPECT_NEAR(trend.slope(), slope, 1e-12);
  EXPECT_NEAR(trend.level(), end, 1e-11);
  EXPECT_NEAR(trend.slope_error(), 0.5 * std::sqrt(12.0 / (n * (n * n - 1.0))), 1e-12);
  EXPECT_NEAR(trend.level_error(), 0.5 * std::sqrt(2.0 * (2.0 * n - 1.0) / (n * (n + 1.0))), 1e-12);
}

std::string drift(double block_s) {
  return "[[trend]]\nid = 't'\nquantity = 'sample.y_m'\nstd_dev = 0.1\nmemory_s = 400.0\n"
         "horizon_s = 10000.0\nhigh = 12.0\nparameter = 'damping'\nblock_s = " +
         std::to_string(block_s) + "\n";
}

TEST(Trend, TellsADriftLongBeforeItReachesTheLimit) {
  PlainValues values(drift(1.0));
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.1);
  for (int i = 0; i < 3000; ++i) values.feed(10.0 + normal(random));
  EXPECT_TRUE(values.alarms.empty());
  for (int i = 0; i < 1500; ++i) values.feed(10.0 + 5e-4 * i + normal(random));
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_EQ(values.alarms[0].name, "drifting");
  EXPECT_EQ(values.alarms[0].direction, 1);
  EXPECT_LT(values.alarms[0].value, 10.4);
  EXPECT_NEAR(values.last("slope_per_s"), 5e-4, 4.0 * values.last_error("slope_per_s"));
  // (12 - 10.75)/5e-4 s
  EXPECT_NEAR(values.last("time_to_limit_s"), 2500.0, 500.0);
}

TEST(Trend, IsNotBentByOutliersAndTakesAStepAsAStep) {
  PlainValues values(drift(1.0));
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.1);
  for (int i = 0; i < 3000; ++i) {
    values.feed((i > 1000 && i % 200 == 0 ? 30.0 : 10.0) + normal(random));
  }
  EXPECT_TRUE(values.alarms.empty());
  EXPECT_NEAR(values.last("level"), 10.0, 0.1);
  for (int i = 0; i < 400; ++i) values.feed(11.0 + normal(random));
  EXPECT_NEAR(values.last("level"), 11.0, 0.1);
}

}  // namespace
}  // namespace estimator::fdi
