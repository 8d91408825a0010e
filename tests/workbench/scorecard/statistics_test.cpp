// Limits against SciPy: chi2.ppf(0.95, 2 n + 2) / (2 T), beta.ppf(0.05, k, n - k + 1).
#include "workbench/scorecard/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "workbench/scorecard/search.h"

namespace workbench::scorecard {
namespace {

constexpr double kRounding = 1e-8;  // relative; the quantiles are iterated

TEST(PoissonLimit, IsSciPys) {
  const struct {
    int events;
    double hours, upper;
  } cases[] = {{0, 72.0, 0.04160739269},
               {0, 12.0, 0.2496443561},
               {1, 1.0, 4.743864518},
               {3, 10.0, 0.7753656528},
               {12, 2.5, 7.777027732}};
  for (const auto& c : cases) {
    EXPECT_NEAR(poisson_upper(c.events, c.hours) / c.upper, 1.0, kRounding) << c.events;
  }
  EXPECT_NEAR(poisson_upper(2, 5.0, 0.9) / 1.064464068, 1.0, kRounding);
}

TEST(PoissonLimit, OfNoAlarmInSeventyTwoHoursIsUnderOneADay) {
  EXPECT_LT(poisson_upper(0, 72.0), 1.0 / 24.0);
  EXPECT_GT(poisson_upper(0, 71.0), 1.0 / 24.0);
  EXPECT_TRUE(std::isinf(poisson_upper(0, 0.0)));
}

TEST(ClopperPearsonLimit, IsSciPys) {
  const struct {
    int k, n;
    double lower;
  } cases[] = {{20, 20, 0.8608916593},
               {19, 20, 0.7838938358},
               {59, 59, 0.9504923901},
               {10, 20, 0.3019539113},
               {1, 5, 0.01020621831}};
  for (const auto& c : cases) {
    EXPECT_NEAR(clopper_pearson_lower(c.k, c.n), c.lower, kRounding) << c.k << " of " << c.n;
  }
  EXPECT_NEAR(clopper_pearson_lower(7, 10, 0.9), 0.4482691676, kRounding);
  EXPECT_EQ(clopper_pearson_lower(0, 10), 0.0);
}

TEST(Quantile, IsTheLeastValueThatTheShareDoesNotExceed) {
  const std::vector<double> values{5,  3,  1,  4,  2,  6,  8,  7,  10, 9,
                                   20, 19, 18, 17, 16, 15, 14, 13, 12, 11};
  EXPECT_EQ(quantile(values, 0.5), 10.0);
  EXPECT_EQ(quantile(values, 0.95), 19.0);
  EXPECT_EQ(quantile({3.0}, 0.95), 3.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Quantile, OfMoreMissesThanTheShareAllowsIsNever) {
  const double never = std::numeric_limits<double>::infinity();
  EXPECT_EQ(quantile({1.0, never, 2.0, 3.0}, 0.75), 3.0);
  EXPECT_EQ(quantile({1.0, never, 2.0, 3.0}, 0.95), never);
}

TEST(LadderSearch, FindsTheFirstRungThatPassesInFewSteps) {
  for (std::size_t rungs = 1; rungs <= 17; ++rungs) {
    for (std::size_t first = 0; first <= rungs; ++first) {
      LadderSearch search(rungs);
      int steps = 0;
      while (const auto rung = search.next()) {
        ASSERT_LT(*rung, rungs);
        search.tell(*rung >= first);
        ++steps;
      }
      EXPECT_LE(steps, std::ceil(std::log2(static_cast<double>(rungs) + 1.0)));
      if (first < rungs) {
        EXPECT_EQ(search.smallest(), first);
      } else {
        EXPECT_FALSE(search.smallest());
      }
    }
  }
}

TEST(Decided, AsSoonAsTheRestCannotChangeIt) {
  EXPECT_EQ(decided(0, 1, 20, 0.95), std::nullopt);
  EXPECT_EQ(decided(0, 2, 20, 0.95), false);
  EXPECT_EQ(decided(18, 18, 20, 0.95), std::nullopt);
  EXPECT_EQ(decided(19, 19, 20, 0.95), true);
  EXPECT_EQ(decided(19, 20, 20, 0.95), true);
  EXPECT_EQ(decided(4, 5, 5, 0.95), false);
}

}  // namespace
}  // namespace workbench::scorecard
