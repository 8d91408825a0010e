// CUSUM and GLR: run lengths against an integral equation and against simulated runs, and what a
// pipeline makes of a change.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimator/fdi/average_run_length.h"
#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

using fdi_test::PlainValues;
using fdi_test::refusal;

struct RunLength {
  double k, h, shift, blocks;
};
// Page's integral equation L(s) = 1 + L(0) Phi(k - s - mu) + int_0^h L(y) phi(y - s + k - mu) dy,
// solved in Octave by 80 Gauss-Legendre points:
//   b = (1:79)./sqrt(4*(1:79).^2-1); [V,D] = eig(diag(b,1)+diag(b,-1));
//   y = [0 (diag(D)'+1)*h/2]; w = h*V(1,:).^2; A = eye(81); A(:,1) -= Phi(k-y'-mu);
//   A(:,2:end) -= w.*phi(y(2:end)-y'+k-mu); L = (A\ones(81,1))(1)
constexpr RunLength kRunLengths[] = {{0.5, 4, 0, 335.36758},  {0.5, 5, 0, 930.88701},
                                     {0.5, 4, 1, 8.3832021},  {0.25, 8, 0, 736.78775},
                                     {0.5, 8, 0, 18965.728},  {1, 3, 0, 1962.7945},
                                     {0.5, 10, 0, 140264.98}, {0.5, 5, -0.1, 2229.7127}};
constexpr double kChain = 1e-2;  // 101 states against the integral

TEST(AverageRunLength, OfCusumIsThatOfPagesIntegralEquation) {
  for (const RunLength& each : kRunLengths) {
    EXPECT_NEAR(cusum_run_length(each.k, each.h, each.shift), each.blocks, kChain * each.blocks)
        << each.k << ' ' << each.h;
  }
}

TEST(AverageRunLength, OfCusumIsNearSiegmundsClosedForm) {
  // (exp(2 k b) - 2 k b - 1)/(2 k^2), b = h + 1.166: Siegmund, Sequential Analysis, 1985, 2.52.
  for (const double k : {0.25, 0.5}) {
    const double x = 2.0 * k * (6.0 + 1.166);
    const double siegmund = (std::exp(x) - x - 1.0) / (2.0 * k * k);
    EXPECT_NEAR(cusum_run_length(k, 6.0), siegmund, 0.02 * siegmund);
  }
}

TEST(AverageRunLength, ThresholdsGiveTheRunLengthBack) {
  const double h = cusum_threshold(0.5, 43200.0);
  EXPECT_NEAR(0.5 * cusum_run_length(0.5, h), 43200.0, 1.0);
  EXPECT_GT(cusum_threshold(0.5, 43200.0, 0.1), h);
  // One value alone: P(|z| > b) = 1/1000, b = 3.2905267315 (normal table).
  EXPECT_NEAR(glr_threshold(1000.0, 1), 3.2905267315, 1e-6);
}

/// Mean of `runs` runs until `next` says that there is an alarm.
template <class Start>
double mean_run(int runs, Start&& start) {
  double total = 0.0;
  for (int i = 0; i < runs; ++i) {
    auto next = start();
    for (double n = 1.0;; n += 1.0) {
      if (!next()) continue;
      total += n;
      break;
    }
  }
  return total / runs;
}

std::string rules(const std::string& kind, double false_alarm_time_s,
                  const std::string& more = "") {
  return "[[" + kind + "]]\nid = 'test'\nquantity = 'sample.y_m'\nmean = 10.0\nstd_dev = 2.0\n" +
         "false_alarm_time_s = " + std::to_string(false_alarm_time_s) + "\n" + more;
}

class EveryTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Tests, EveryTest, testing::Values("cusum", "glr"));

TEST_P(EveryTest, KeepsToItsStatedTimeBetweenFalseAlarms) {
  constexpr int kRuns = 300;
  constexpr double kTime_s = 400.0;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(10.0, 2.0);
  auto values = std::make_shared<PlainValues>(rules(GetParam(), kTime_s));
  const double mean = mean_run(kRuns, [&] {
    values->restart();
    return [values, &random, &normal] {
      values->feed(normal(random));
      return !values->alarms.empty();
    };
  });
  // Runs are exponential: the mean of 300 has a standard error of 6 %. The GLR's threshold is set
  // for up to 1.2 times what is stated.
  EXPECT_GT(mean, 0.8 * kTime_s);
  EXPECT_LT(mean, 1.45 * kTime_s);
}

TEST_P(EveryTest, FalseAlarmsAreNoMoreOftenThanStatedForOverlappingWindows) {
  // Moving means of 20 values, all of them, in blocks of 20: neighbours have a correlation of 1/4,
  // a variance over long runs of 1/20.
  constexpr int kWindow = 20;
  constexpr double kTime_s = 8000.0;  // 400 blocks
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  char deviation[64];
  std::snprintf(deviation, sizeof deviation, "%.17g", 1.0 / std::sqrt(20.0));
  const std::string text =
      "[[" + std::string(GetParam()) +
      "]]\nid = 'test'\nquantity = 'sample.y_m'\nmean = 0.0\nstd_dev = " + deviation +
      "\nblock_s = 20.0\nfalse_alarm_time_s = 8000.0\n";
  auto values = std::make_shared<PlainValues>(text);
  const double mean = mean_run(150, [&] {
    values->restart();
    auto window = std::make_shared<std::vector<double>>(kWindow);
    for (double& v : *window) v = normal(random);
    auto at = std::make_shared<std::size_t>(0);
    return [=, &random, &normal] {
      (*window)[(*at)++ % kWindow] = normal(random);
      double sum = 0.0;
      for (const double v : *window) sum += v;
      values->feed(sum / kWindow);
      return !values->alarms.empty();
    };
  });
  EXPECT_GT(mean, 0.8 * kTime_s);
  EXPECT_LT(mean, 2.5 * kTime_s) << "and not so seldom that the test has lost its edge";
}

TEST_P(EveryTest, FindsAChangeSaysHowLargeItIsAndSinceWhenAndGoesWithIt) {
  PlainValues values(rules(GetParam(), 1e5, "parameter = 'gain'\nfalls_with_parameter = true\n"));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 2.0);
  for (int i = 0; i < 500; ++i) values.feed(10.0 + normal(random));
  ASSERT_TRUE(values.alarms.empty());
  for (int i = 0; i < 40; ++i) values.feed(6.0 + normal(random));
  ASSERT_EQ(values.alarms.size(), 1U);
  const Alarm& alarm = values.alarms[0];
  EXPECT_EQ(alarm.source, "test");
  EXPECT_EQ(alarm.name, "changed");
  EXPECT_EQ(alarm.parameter, "gain");
  EXPECT_EQ(alarm.direction, -1);
  EXPECT_TRUE(alarm.falls_with_parameter);
  EXPECT_LT(alarm.tick, 525) << "a shift of two standard deviations";
  // -4 with a standard error of 2/sqrt(40), since 40 s or a few more.
  EXPECT_NEAR(values.last("shift"), -4.0, 4.0 * 2.0 / std::sqrt(40.0));
  EXPECT_NEAR(values.last("since_s"), 40.0, 5.0);
  for (int i = 0; i < 300; ++i) values.feed(10.0 + normal(random));
  ASSERT_EQ(values.alarms.size(), 2U);
  EXPECT_EQ(values.alarms[1].severity, Severity::ok);
}

TEST_P(EveryTest, CountsAnUncertainMeanAgainstItself) {
  PlainValues sure(rules(GetParam(), 1000.0));
  PlainValues unsure(rules(GetParam(), 1000.0, "mean_error = 0.2\n"));
  sure.feed(14.0);
  unsure.feed(14.0);
  EXPECT_LT(unsure.last("statistic"), sure.last("statistic"));
}

TEST_P(EveryTest, StandsStillWhileItsValueIsMissing) {
  PlainValues values(rules(GetParam(), 1000.0));
  values.feed(13.0);
  const double before = values.last("statistic");
  EXPECT_GT(before, 0.0);
  values.feed(std::nan(""));
  EXPECT_FALSE(values.valid);
  EXPECT_FALSE(values.reason.empty());
  values.feed(10.0);
  EXPECT_TRUE(values.valid);
  EXPECT_LE(values.last("statistic"), before);
}

TEST_P(EveryTest, IsRefusedUntrained) {
  const std::string head =
      "[[" + std::string(GetParam()) + "]]\nid = 'test'\nquantity = 'sample.y_m'\n";
  EXPECT_NE(refusal(head).find("test: is not trained"), std::string::npos);
  EXPECT_NE(refusal(head + "mean = 0.0\nstd_dev = 1.0\nfalse_alarm_time_s = 5.0\n").find("ten"),
            std::string::npos);
}

TEST(Cusum, TakesAsLongToFindTheShiftItIsMadeForAsTheChainSays) {
  // Two-sided with k = 0.5, 500 s between false alarms: h = 5.07; one side of shift 1 alone gives
  // the delay, since the other hardly ever alarms first.
  const double expected = cusum_run_length(0.5, cusum_threshold(0.5, 500.0), 1.0);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(12.0, 2.0);
  auto values = std::make_shared<PlainValues>(rules("cusum", 500.0));
  const double mean = mean_run(400, [&] {
    values->restart();
    return [values, &random, &normal] {
      values->feed(normal(random));
      return !values->alarms.empty();
    };
  });
  EXPECT_NEAR(mean, expected, 0.1 * expected);  // four standard errors
}

TEST(Cusum, LetsGoOfALargeChangeSoonAfterItsEnd) {
  // 100 standard deviations, and then as before: what has added up is taken off at a quarter of it.
  PlainValues values(rules("cusum", 1e5));
  for (int i = 0; i < 20; ++i) values.feed(210.0);
  ASSERT_EQ(values.alarms.size(), 1U);
  for (int i = 0; i < 3; ++i) values.feed(10.0);
  ASSERT_EQ(values.alarms.size(), 2U);
  EXPECT_EQ(values.alarms[1].severity, Severity::ok);
}

}  // namespace
}  // namespace estimator::fdi
