#include "daemon/control/guard_limits.h"

#include <gtest/gtest.h>

namespace monitor::control {
namespace {

std::vector<GuardConfig> travel(double low_m, double high_m) {
  GuardConfig guard;
  guard.id = guard.kind = "travel";
  guard.low_m = low_m;
  guard.high_m = high_m;
  return {guard};
}

TEST(GuardLimits, AreLooserWhereMorePasses) {
  const std::vector<GuardConfig> before = travel(0.2, 0.4);
  EXPECT_EQ(loosened_limit(before, before), "");
  EXPECT_EQ(loosened_limit(before, travel(0.21, 0.39)), "");
  EXPECT_EQ(loosened_limit(before, travel(0.2, 0.41)), "travel: high_m");
  EXPECT_EQ(loosened_limit(before, travel(0.19, 0.39)), "travel: low_m");
}

/// A frozen reading passes the longer, the smaller the motion that counts, the larger the command.
TEST(GuardLimits, OfAFrozenReadingAreLooserInTheOtherDirectionForTheLeastMotion) {
  GuardConfig frozen;
  frozen.id = frozen.kind = "frozen";
  frozen.least_m = 1e-4;
  frozen.command_V = 0.5;
  frozen.time_s = 0.2;
  const auto changed = [&](double GuardConfig::*limit, double factor) {
    GuardConfig next = frozen;
    next.*limit *= factor;
    return loosened_limit({frozen}, {next});
  };
  EXPECT_EQ(changed(&GuardConfig::least_m, 0.5), "frozen: least_m");
  EXPECT_EQ(changed(&GuardConfig::least_m, 2.0), "");
  EXPECT_EQ(changed(&GuardConfig::command_V, 2.0), "frozen: command_V");
  EXPECT_EQ(changed(&GuardConfig::command_V, 0.5), "");
  EXPECT_EQ(changed(&GuardConfig::time_s, 2.0), "frozen: time_s");
  EXPECT_EQ(changed(&GuardConfig::time_s, 0.5), "");
}

TEST(GuardLimits, ALimitThatWasNotThereIsTighterAndOneThatGoesIsLooser) {
  const double kNone = std::numeric_limits<double>::infinity();
  EXPECT_EQ(loosened_limit(travel(-kNone, kNone), travel(0.2, 0.4)), "");
  EXPECT_EQ(loosened_limit(travel(0.2, 0.4), travel(0.2, kNone)), "travel: high_m");
}

TEST(GuardLimits, AreTakenByIdAndNothingElseIs) {
  std::vector<GuardConfig> before = travel(0.2, 0.4);
  std::vector<GuardConfig> after = travel(0.25, 0.35);
  after[0].action = "indicate";
  GuardConfig other;
  other.id = "other";
  after.insert(after.begin(), other);
  const std::vector<GuardConfig> taken = with_limits_of(before, after);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken[0].low_m, 0.25);
  EXPECT_EQ(taken[0].high_m, 0.35);
  EXPECT_EQ(taken[0].action, "latch");
}

TEST(GuardLimits, AreTheNumbersOfAGuard) {
  for (const char* key : {"low_m", "time_s", "high_Pa"}) EXPECT_TRUE(is_guard_limit(key)) << key;
  for (const char* key : {"kind", "action", "id", "channel", "guidance"}) {
    EXPECT_FALSE(is_guard_limit(key)) << key;
  }
}

}  // namespace
}  // namespace monitor::control
