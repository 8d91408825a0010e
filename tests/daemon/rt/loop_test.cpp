// One tick: read before write, the state machine's outputs, commands, gaps, drops.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::ArmingState;
using control::Event;

TEST(Loop, WritesNullUntilItIsArmedAndStarted) {
  LoopBench bench;
  bench.tick();
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
  bench.command(Event::arm);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::armed);
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
  bench.command(Event::start);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::run);
  EXPECT_NEAR(bench.last_V(), kController_V, kRounding_V);
  bench.command(Event::stop);
  bench.tick();
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
}

TEST(Loop, SampleCarriesWhatWasReadAskedForAndApplied) {
  LoopBench bench;
  bench.run();
  bench.rig.y_m = 0.25;
  bench.rig.read_ns = 40'000;
  const config::signals::Sample sample = bench.sample();
  EXPECT_EQ(sample.tick, 1);
  EXPECT_DOUBLE_EQ(sample.y_m, 0.25);
  EXPECT_DOUBLE_EQ(sample.reference_m, 0.3);
  EXPECT_NEAR(sample.u_requested_V, kFakeNull_V + 5.0, kRounding_V);
  EXPECT_EQ(sample.u_applied_V, bench.last_V());
  EXPECT_EQ(sample.t_read_ns, kFakePeriod_ns);
  EXPECT_EQ(sample.t_write_ns, kFakePeriod_ns + 40'000) << "y is read before u is written";
  EXPECT_EQ(sample.state, static_cast<std::uint8_t>(ArmingState::run));
  EXPECT_FALSE(sample.saturated);
  bench.rig.y_m = -0.5;
  EXPECT_TRUE(bench.sample().saturated);
}

TEST(Loop, WithoutAValveIsMonitorAndPassesOnTheMeasuredCommand) {
  LoopBench bench({}, false);
  bench.rig.command_V = 1.25;
  bench.rig.command_saturated = true;
  bench.command(Event::arm);
  bench.command(Event::start);
  const config::signals::Sample sample = bench.sample();
  EXPECT_EQ(bench.state(), ArmingState::monitor);
  EXPECT_TRUE(bench.rig.writes.empty());
  EXPECT_EQ(sample.u_applied_V, 1.25);
  EXPECT_TRUE(sample.saturated);
  EXPECT_TRUE(std::isnan(sample.u_requested_V));
  EXPECT_TRUE(std::isnan(sample.reference_m));
  EXPECT_EQ(sample.t_write_ns, 0);
  EXPECT_EQ(bench.stats.rejected_commands.value(), 2);
}

TEST(Loop, EndsWithTheRecord) {
  LoopBench bench({}, false);
  bench.rig.end_tick = 3;
  EXPECT_TRUE(bench.tick());
  EXPECT_TRUE(bench.tick());
  EXPECT_TRUE(bench.tick());
  EXPECT_FALSE(bench.tick());
  EXPECT_EQ(bench.stats.ticks.value(), 3);
}

TEST(Loop, DropsCommandsThatHaveExpired) {
  LoopBench bench;
  bench.tick();
  bench.command(Event::arm, kFakePeriod_ns);  // due at the very time of the next tick: too late
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
  EXPECT_EQ(bench.stats.expired_commands.value(), 1);
  bench.command(Event::arm, kFakePeriod_ns + 1);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::armed);
}

TEST(Loop, ReferenceBeginsAtTheStartAndACommandedOneTakesItsPlace) {
  LoopBench bench;
  bench.run();
  LoopCommand command;
  command.kind = LoopCommand::Kind::sine;
  command.centre_m = 0.2;
  command.amplitude_m = 0.01;
  command.frequency_Hz = 10.0;
  command.expires_ns = INT64_MAX;
  bench.commands.push(command);
  for (int k = 0; k < 30; ++k) {
    EXPECT_NEAR(bench.sample().reference_m,
                0.2 + 0.01 * std::sin(2.0 * M_PI * 10.0 * k * kFakeSampleTime_s), 1e-12);
  }
}

TEST(Loop, CountsSamplesDroppedByAFullQueueAndMarksTheGap) {
  LoopBench bench;
  constexpr int kCapacity = 2000;
  for (int i = 0; i < kCapacity + 7; ++i) bench.tick();
  EXPECT_EQ(bench.stats.dropped_samples.value(), 7);
  config::signals::Sample sample;
  std::int64_t tick = 0;
  while (bench.samples.pop(sample)) {
    EXPECT_EQ(sample.tick, tick++) << "the newest must be dropped, not the oldest";
    EXPECT_EQ(sample.gap, 0);
  }
  EXPECT_EQ(tick, kCapacity);
  EXPECT_EQ(bench.sample().gap, 7);
  EXPECT_EQ(bench.sample().gap, 0);
}

}  // namespace
}  // namespace monitor::rt
