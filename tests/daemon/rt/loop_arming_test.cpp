// Orders and inputs in the loop: what an order is answered, e-stop, enable, a command that is only
// watched.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::ArmingState;
using control::Event;
using control::RejectReason;

constexpr int kMaxBadInARow = 3;  // of LoopConfig

/// A bench with one switch of that role.
struct SwitchBench : LoopBench {
  SwitchBench(hal::InputRole role, double value, const SafetyRules& rules = without_blending())
      : LoopBench({}, true, rules), input(std::make_shared<FakeInput>(value)) {
    inputs.push_back({"switch", role, input});
  }
  std::shared_ptr<FakeInput> input;
};

TEST(Answer, PassesThroughOneWord) {
  const control::CommandAnswer answer{0xfedcba98U, RejectReason::guard, ArmingState::latched, 31};
  const control::CommandAnswer back = control::unpack(control::pack(answer));
  EXPECT_EQ(back.number, answer.number);
  EXPECT_EQ(back.reject_reason, answer.reject_reason);
  EXPECT_EQ(back.state, answer.state);
  EXPECT_EQ(back.guard, answer.guard);
}

TEST(Arm, IsAnsweredWithTheStateOrTheReason) {
  LoopBench bench;
  EXPECT_EQ(ask(bench, Event::start).reject_reason, RejectReason::state);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::none);
  EXPECT_EQ(bench.state(), ArmingState::armed);
  EXPECT_EQ(ask(bench, Event::start).reject_reason, RejectReason::none);
  EXPECT_EQ(bench.state(), ArmingState::run);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::state);
  bench.loop().close();
  EXPECT_EQ(ask(bench, Event::disarm).reject_reason, RejectReason::none);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::closing);
  LoopBench monitor({}, false);
  EXPECT_EQ(ask(monitor, Event::arm).reject_reason, RejectReason::monitor);
}

TEST(Arm, IsRefusedWithoutACalibration) {
  SafetyRules rules = without_blending();
  rules.may_arm = false;
  LoopBench bench({}, true, rules);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::calibration);
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
}

TEST(Enable, IsNeededToArmAndItsLossDisarmsAtOnce) {
  SwitchBench bench(hal::InputRole::enable, 0.0);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::enable);
  bench.input->value = 1.0;
  bench.run();
  EXPECT_EQ(bench.state(), ArmingState::run);
  for (const double value : {0.0, 0.9}) {
    bench.input->value = value;
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::disarmed) << value;
    EXPECT_EQ(bench.last_V(), kFakeNull_V);
    bench.input->value = 1.0;
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::disarmed) << "it does not arm by itself";
    bench.run();
    ASSERT_EQ(bench.state(), ArmingState::run);
  }
}

TEST(Switches, OneThatCannotBeReadMeansNullAtOnceAndTripsWhenItLasts) {
  const struct {
    hal::InputRole role;
    ArmingState after;
  } cases[] = {{hal::InputRole::enable, ArmingState::disarmed},
               {hal::InputRole::e_stop, ArmingState::latched}};
  const std::pair<double, config::signals::Quality> unread[] = {
      {std::nan(""), config::signals::Quality::good}, {1.0, config::signals::Quality::bad}};
  for (const auto& [role, after] : cases) {
    for (const auto& [value, quality] : unread) {
      SwitchBench bench(role, 1.0);
      bench.run();
      for (const int ticks : {1, kMaxBadInARow, kMaxBadInARow + 1}) {
        bench.input->value = value;
        bench.input->quality = quality;
        for (int i = 0; i < ticks; ++i) {
          bench.tick();
          EXPECT_EQ(bench.last_V(), kFakeNull_V);
          EXPECT_EQ(bench.state(), i < kMaxBadInARow ? ArmingState::run : after) << ticks;
        }
        bench.input->value = 1.0;
        bench.input->quality = config::signals::Quality::good;
        bench.tick();
        EXPECT_EQ(bench.last_V() != kFakeNull_V, ticks <= kMaxBadInARow) << ticks;
      }
    }
  }
}

TEST(Switches, OneThatHasNeverBeenReadCountsAsOff) {
  SwitchBench bench(hal::InputRole::e_stop, std::nan(""));
  bench.tick();
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::guard);
}

TEST(EmergencyStop, LatchesFromRunAndArmed) {
  for (const bool run : {true, false}) {
    SwitchBench bench(hal::InputRole::e_stop, 1.0);
    bench.command(Event::arm);
    if (run) bench.command(Event::start);
    bench.tick();
    bench.input->value = 0.0;
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::latched);
    EXPECT_EQ(bench.last_V(), kFakeNull_V);
    EXPECT_EQ(bench.stats.trip.load(), Trip::e_stop);
    bench.input->value = 1.0;
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::latched) << "release alone leads nowhere";
    EXPECT_EQ(ask(bench, Event::reset).reject_reason, RejectReason::none);
    EXPECT_EQ(bench.state(), ArmingState::disarmed);
  }
}

TEST(EmergencyStop, WiredTheWrongWayStaysDisarmedAndSaysSo) {
  SwitchBench bench(hal::InputRole::e_stop, 0.0);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
  const control::CommandAnswer answer = ask(bench, Event::arm);
  EXPECT_EQ(answer.reject_reason, RejectReason::guard);
  EXPECT_EQ(answer.guard, static_cast<std::uint8_t>(control::GuardKind::e_stop));
  EXPECT_EQ(bench.stats.guards.active(), 1U) << "the alarm is there all the time";
}

TEST(Monitor, TakesTheCommandFromItsInput) {
  LoopBench bench({}, false);
  const auto input = std::make_shared<FakeInput>(2.5);
  bench.inputs.push_back({"u", hal::InputRole::valve_command, input});
  bench.rig.command_V = 9.0;
  // The loop asks at its construction which roles there are, so this one is made anew.
  control::Sine still(0.0, 0.0, 0.0);
  Loop loop({},
            {bench.clock, bench.rig, nullptr, still, bench.samples, bench.commands, bench.stats,
             nullptr, &bench.inputs},
            control::Controller({1.0}, {}, kFakeSampleTime_s), kFakeSampleTime_s);
  Grid grid(0, kFakePeriod_ns);
  const auto u_V = [&] {
    loop.tick(grid.next(bench.clock));
    config::signals::Sample sample;
    bench.samples.pop(sample);
    EXPECT_EQ(sample.state, 0);
    return sample.u_applied_V;
  };
  EXPECT_EQ(u_V(), 2.5);
  input->quality = config::signals::Quality::bad;
  EXPECT_TRUE(std::isnan(u_V())) << "a missing command is missing";
  EXPECT_EQ(bench.stats.inputs[0].good.value(), 1);
  EXPECT_EQ(bench.stats.inputs[0].bad.value(), 1);
  EXPECT_TRUE(bench.rig.writes.empty());
}

TEST(Missing, ForbidsToArmButLatchesNothingThatIsDisarmed) {
  LoopBench bench;
  bench.rig.quality = config::signals::Quality::bad;
  for (int k = 0; k < 10; ++k) bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
  const control::CommandAnswer answer = ask(bench, Event::arm);
  EXPECT_EQ(answer.reject_reason, RejectReason::guard);
  EXPECT_EQ(answer.guard, static_cast<std::uint8_t>(control::GuardKind::missing));
  bench.rig.quality = config::signals::Quality::good;
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::none);
}

}  // namespace
}  // namespace monitor::rt
