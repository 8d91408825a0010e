#include "daemon/rt/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace monitor::rt {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(OverrunRule, CountsPeriodsInARowUntilAGoodTick) {
  OverrunRule rule(5, 1000);
  EXPECT_FALSE(rule.add(3, 0));
  EXPECT_FALSE(rule.add(2, 1));
  EXPECT_FALSE(rule.add(0, 2));
  EXPECT_FALSE(rule.add(5, 3));
  EXPECT_TRUE(rule.add(1, 4));
}

TEST(OverrunRule, AgreesWithCountingEveryLossOfTheLastMinute) {
  for (const int allowed : {0, 1, 7, 60}) {
    OverrunRule rule(1000000, allowed);
    std::mt19937 random(static_cast<unsigned>(allowed));
    std::vector<std::int64_t> losses_ns;
    std::int64_t now_ns = 0;
    int too_many = 0;
    for (int i = 0; i < 3000; ++i) {
      now_ns += static_cast<std::int64_t>(random() % 40) * kSecond_ns / (allowed + 1);
      const auto lost = static_cast<std::int64_t>(random() % 3);
      for (int k = 0; k < lost; ++k) losses_ns.push_back(now_ns);
      const auto recent = std::count_if(losses_ns.begin(), losses_ns.end(), [&](std::int64_t t) {
        return now_ns - t < 60 * kSecond_ns;
      });
      const bool expected = lost > 0 && recent > allowed;
      ASSERT_EQ(rule.add(lost, now_ns), expected) << "allowed " << allowed << ", step " << i;
      too_many += expected ? 1 : 0;
    }
    EXPECT_GT(too_many, 10);
  }
}

}  // namespace
}  // namespace monitor::rt
