// Which rod sensor counts: what takes one out, who takes over, and what brings it back.
#include "daemon/control/position_voter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace monitor::control {
namespace {

constexpr double kTs_s = 0.005;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding_m = 1e-12;

FailoverConfig failover() {
  FailoverConfig config;
  config.present = true;
  config.tolerance_m = 1e-3;
  config.confirm_s = 0.02;  // four ticks
  return config;
}

std::vector<GuardConfig> guards() {
  SafetyConfig config;
  GuardConfig jump;
  jump.id = jump.kind = "jump";
  jump.limit_m = 5e-3;
  GuardConfig frozen;
  frozen.id = frozen.kind = "frozen";
  frozen.least_m = 1e-4;
  frozen.command_V = 0.1;
  frozen.time_s = 0.05;  // ten ticks
  config.guards = {jump, frozen};
  return all_guards(config, Action::latch);
}

/// Sensors on a rod that the test moves.
class Bench {
 public:
  explicit Bench(const FailoverConfig& config = failover())
      : voter(config, guards(), {kTs_s, 3, 0.05}) {}
  void tick(const std::vector<double>& y_m, double command_V = 1.0) {
    std::vector<RodReading> rods(y_m.size());
    for (std::size_t i = 0; i < y_m.size(); ++i) rods[i].y_m = y_m[i];
    voter.update(rods, static_cast<double>(k++) * kTs_s, command_V, true);
  }
  PositionVoter voter;
  int k = 0;
};

TEST(PositionVoter, GoesOverInTheTickInWhichTheReadingIsMissing) {
  Bench bench;
  bench.tick({0.1, 0.1002});
  bench.tick({kNaN, 0.1003});
  EXPECT_EQ(bench.voter.in_charge(), 1U);
  EXPECT_TRUE(bench.voter.changed());
  EXPECT_EQ(bench.voter.fault(0), RodFault::missing);
  EXPECT_NEAR(0.1003 + bench.voter.bump_m(), 0.1001, kRounding_m)
      << "the offset is taken away, the motion of 0.1 mm is not";
  bench.tick({0.1004, 0.1004});
  EXPECT_EQ(bench.voter.in_charge(), 1U) << "it does not flap back";
  EXPECT_FALSE(bench.voter.changed());
}

TEST(PositionVoter, LetsTheOffsetFadeAtTheGivenSpeed) {
  Bench bench;
  bench.tick({0.1, 0.101});
  bench.tick({kNaN, 0.101});
  for (int n = 0; n <= 4; ++n) {
    EXPECT_NEAR(bench.voter.bump_m(), -1e-3 + n * 0.05 * kTs_s, kRounding_m) << n;
    bench.tick({kNaN, 0.101});
  }
  bench.tick({kNaN, 0.101});
  EXPECT_EQ(bench.voter.bump_m(), 0.0);
}

TEST(PositionVoter, GoesOverInTheTickOfAJump) {
  Bench bench;
  bench.tick({0.1, 0.1});
  bench.tick({0.12, 0.1001});
  EXPECT_EQ(bench.voter.in_charge(), 1U);
  EXPECT_EQ(bench.voter.fault(0), RodFault::jump);
  EXPECT_NEAR(bench.voter.bump_m(), 0.0, kRounding_m) << "the jump itself is not carried on";
}

TEST(PositionVoter, CallsASensorFrozenOnlyWhereAnotherSawTheRodMove) {
  for (const bool moves : {true, false}) {
    Bench bench;
    for (int n = 0; n <= 12; ++n) bench.tick({0.1, 0.1 + (moves ? 1e-4 * n : 0.0)});
    EXPECT_EQ(bench.voter.fault(0), moves ? RodFault::frozen : RodFault::none);
    EXPECT_EQ(bench.voter.in_charge(), moves ? 1U : 0U);
  }
}

TEST(PositionVoter, VotesTheSensorOutThatIsOffTheMiddleOfThree) {
  for (const std::size_t wrong : {0U, 2U}) {
    Bench bench;
    std::vector<double> y_m = {0.1, 0.1003, 0.0998};
    bench.tick(y_m);
    y_m[wrong] += 2e-3;
    for (int n = 0; n < 3; ++n) bench.tick(y_m);
    EXPECT_EQ(bench.voter.fault(wrong), RodFault::none) << "not confirmed yet";
    EXPECT_LT(bench.voter.difference_m(), 1e-3) << "the two others agree";
    bench.tick(y_m);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(bench.voter.fault(i), i == wrong ? RodFault::outvoted : RodFault::none) << i;
    }
    EXPECT_EQ(bench.voter.in_charge(), wrong == 0 ? 1U : 0U);
  }
}

TEST(PositionVoter, CannotTellWhichOfTwoIsWrong) {
  Bench bench;
  for (int n = 0; n < 20; ++n) bench.tick({0.1, 0.103});
  EXPECT_EQ(bench.voter.in_charge(), 0U);
  EXPECT_EQ(bench.voter.fault(0), RodFault::none);
  EXPECT_NEAR(bench.voter.difference_m(), 3e-3, kRounding_m);
}

TEST(PositionVoter, ThatAllThreeDifferIsADisagreement) {
  Bench bench;
  bench.tick({0.1, 0.103, 0.108});
  EXPECT_NEAR(bench.voter.difference_m(), 3e-3, kRounding_m);
}

TEST(PositionVoter, StaysWhereNoOtherIsLeft) {
  Bench bench;
  bench.tick({0.1, 0.1});
  bench.tick({kNaN, 0.1});
  for (int n = 0; n < 10; ++n) bench.tick({kNaN, kNaN});
  EXPECT_EQ(bench.voter.in_charge(), 1U);
  EXPECT_EQ(bench.voter.fault(1), RodFault::none) << "the guards see to it";
}

TEST(PositionVoter, ComesBackWhenForgivenAndRight) {
  Bench bench;
  bench.tick({0.1, 0.1});
  bench.tick({kNaN, 0.1});
  bench.voter.readmit();
  bench.tick({kNaN, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 1U) << "readmitted, but still missing";
  bench.tick({0.1, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 1U);
  bench.voter.readmit();
  bench.tick({0.1, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 0U);
  EXPECT_EQ(bench.voter.fault(0), RodFault::none);
}

TEST(PositionVoter, ComesBackAfterTheConfiguredTimeOfRightReadingsInARow) {
  FailoverConfig config = failover();
  config.return_s = 0.05;  // ten ticks
  Bench bench(config);
  bench.tick({0.1, 0.1});
  bench.tick({kNaN, 0.1});
  for (int n = 0; n < 8; ++n) bench.tick({0.1, 0.1});
  bench.tick({0.105, 0.1});
  for (int n = 0; n < 9; ++n) bench.tick({0.1, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 1U) << "one reading off the other begins the time anew";
  bench.tick({0.1, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 0U);
}

TEST(PositionVoter, WithoutFailoverTheFirstStaysInCharge) {
  Bench bench{FailoverConfig{}};
  bench.tick({0.1, 0.102});
  bench.tick({kNaN, 0.1, 0.1});
  EXPECT_EQ(bench.voter.in_charge(), 0U);
  bench.tick({0.1, 0.102, 0.097});
  EXPECT_NEAR(bench.voter.difference_m(), 3e-3, kRounding_m);
}

}  // namespace
}  // namespace monitor::control
