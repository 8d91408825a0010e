#include "estimator/fdi/learn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

constexpr double kInterval_s = 0.02;
constexpr double kWindow_s = 0.5;

/// Normal values averaged over the window: correlated just like overlapping windows' estimates.
class Overlapping {
 public:
  explicit Overlapping(unsigned seed) : random_(seed), ring_(25) {
    for (double& value : ring_) value = normal_(random_);
    sum_ = std::accumulate(ring_.begin(), ring_.end(), 0.0);
  }
  double next() {
    sum_ -= ring_[at_];
    ring_[at_] = normal_(random_);
    sum_ += ring_[at_];
    at_ = (at_ + 1) % ring_.size();
    return sum_;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<double> ring_;
  std::size_t at_ = 0;
  double sum_ = 0.0;
};

std::vector<double> take(Overlapping& source, double duration_s) {
  std::vector<double> values(static_cast<std::size_t>(duration_s / kInterval_s));
  for (double& value : values) value = source.next();
  return values;
}

TEST(LearnLimits, HoldTheFalseAlarmTimeOnCorrelatedNormalEstimatesWithoutBeingAbsurdlyWide) {
  LearnConfig config;
  config.false_alarm_time_s = 1000.0;
  config.interval_s = kInterval_s;
  config.window_s = kWindow_s;
  constexpr double kWatched_s = 1e5;  // 100 false alarms are allowed in it
  std::vector<int> counts;
  for (unsigned seed = 1; seed <= 11; ++seed) {
    Overlapping source(seed);
    const LearnedLimits limits = learn_limits(take(source, 600.0), config);
    int alarms = 0;
    int quiet = 1000;  // values since the last one outside
    for (double t_s = 0.0; t_s < kWatched_s; t_s += kInterval_s) {
      const double value = source.next();
      const bool outside = value > limits.high || value < limits.low;
      if (outside && quiet > 50) ++alarms;  // excursions a second apart are separate alarms
      quiet = outside ? 0 : quiet + 1;
    }
    counts.push_back(alarms);
  }
  std::sort(counts.begin(), counts.end());
  EXPECT_LE(counts[8], 100);      // nine records of eleven hold it
  EXPECT_LE(counts.back(), 200);  // and none misses it by more than a factor of two
  EXPECT_GE(counts[5], 20);
}

// Independent normal values, one a block: the level of false_alarm_time_s is known exactly.
TEST(LearnLimits, HoldTheirConfidenceFromFewBlocksAndSayHowManyAreEnough) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int kRecords = 100;
  constexpr double kTimes = 10'000.0;  // estimates between two false alarms
  const double exact = 3.8906;         // P(x > exact) = 0.5 / kTimes
  for (const std::size_t blocks : {12U, 19U, 50U}) {
    LearnConfig config;
    config.false_alarm_time_s = kTimes;
    config.interval_s = config.window_s = 1.0;
    int holds = 0;
    for (int i = 0; i < kRecords; ++i) {
      std::vector<double> values(blocks);
      for (double& value : values) value = normal(random);
      const LearnedLimits limits = learn_limits(values, config);
      holds += limits.high >= exact ? 1 : 0;
      EXPECT_GT(limits.widening_ratio, 1.0);
      EXPECT_GT(limits.enough_s, 20.0);
      EXPECT_LT(limits.enough_s, 200.0);
    }
    // 95 %; two standard errors are 4.4 %.
    EXPECT_GE(holds, kRecords * 90 / 100) << blocks;
  }
}

TEST(LearnLimits, FollowTheMotionsPhaseInsteadOfTakingItForNoise) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<double> values;
  for (int i = 0; i < 30000; ++i) {  // 600 s, period 2 s
    values.push_back(5.0 + std::sin(2.0 * M_PI * i / 100.0) + noise(random));
  }
  LearnConfig config;
  config.interval_s = kInterval_s;
  config.window_s = kWindow_s;
  config.period_s = 2.0;
  const LearnedLimits limits = learn_limits(values, config);
  EXPECT_DOUBLE_EQ(limits.block_s, 4.0);
  EXPECT_EQ(limits.blocks, 150U);
  // Extremes 5 +- 1, and beyond them a few standard deviations of the noise; the phases taken as
  // independent normal values would give 5 +- 3.4.
  EXPECT_GT(limits.high, 6.02);
  EXPECT_LT(limits.high, 6.12);
  EXPECT_LT(limits.low, 3.98);
  EXPECT_GT(limits.low, 3.88);
  EXPECT_NEAR(limits.centre, 5.0, 0.001);
}

TEST(LearnLimits, KeepAMarginWhereTheHealthyEstimatesNeverVary) {
  LearnConfig config;
  config.interval_s = 2.0;
  config.window_s = 2.0;
  config.least_margin = 0.01;
  const LearnedLimits limits = learn_limits(std::vector<double>(100, 7.0), config);
  EXPECT_DOUBLE_EQ(limits.high, 7.01);
  EXPECT_DOUBLE_EQ(limits.low, 6.99);
}

TEST(LearnLimits, AreRefusedForTooShortARecord) {
  LearnConfig config;
  config.interval_s = 2.0;
  config.window_s = 2.0;
  try {
    (void)learn_limits(std::vector<double>(9, 1.0), config);
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_NE(std::string(error.what()).find("9 blocks of 2 s"), std::string::npos);
  }
}

TEST(FindPeriod, FindsASinesPeriodAndNoneInNoise) {
  std::vector<double> sine(12000);
  std::vector<double> noise(12000);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < sine.size(); ++i) {
    noise[i] = normal(random);
    sine[i] = std::sin(2.0 * M_PI * 0.005 * static_cast<double>(i) / 1.6) + 0.1 * noise[i];
  }
  EXPECT_NEAR(find_period_s(sine, 0.005), 1.6, 0.021);
  EXPECT_EQ(find_period_s(noise, 0.005), 0.0);
}

}  // namespace
}  // namespace estimator::fdi
