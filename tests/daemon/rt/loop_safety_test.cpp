// Overruns, missing positions, failed writes: what is written, what is counted, where it leads.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::ArmingState;
using control::Event;

TEST(Overrun, HoldsTheOutputMarksTheGapAndGoesOnWithTheLaw) {
  LoopBench bench;
  bench.run();
  bench.sample();
  const std::size_t writes = bench.rig.writes.size();
  bench.clock.advance_ns(3 * kFakePeriod_ns + kFakePeriod_ns / 2);
  const config::signals::Sample sample = bench.sample();
  EXPECT_EQ(bench.rig.writes.size(), writes + 1) << "nothing may be written for periods skipped";
  EXPECT_EQ(sample.tick, 5);
  EXPECT_EQ(sample.gap, 3);
  EXPECT_EQ(sample.t_read_ns, 5 * kFakePeriod_ns) << "the phase of the grid is lost";
  EXPECT_NEAR(sample.u_applied_V, kController_V, kRounding_V);
  EXPECT_EQ(bench.stats.overruns.value(), 1);
  EXPECT_EQ(bench.stats.skipped_periods.value(), 3);
  EXPECT_EQ(bench.sample().gap, 0);
}

TEST(Overrun, WritesNullInTheFirstTickAfterFiftyMilliseconds) {
  for (const auto& [lost, null] : {std::pair{8, false}, {9, true}, {30, true}}) {
    LoopConfig config;
    config.overrun_action = "count";
    LoopBench bench(config);
    bench.run();
    bench.clock.advance_ns(lost * kFakePeriod_ns + 1);  // lost periods, then one more wait
    const config::signals::Sample sample = bench.sample();
    ASSERT_EQ(sample.gap, lost);
    // From tick to tick lost + 1 periods of 5 ms went by: 45 ms, 50 ms, 155 ms.
    EXPECT_EQ(sample.u_applied_V == kFakeNull_V, null) << lost << " periods lost";
    EXPECT_NEAR(bench.sample().u_applied_V, kController_V, kRounding_V);
  }
}

TEST(Overrun, MoreThanAllowedInARowTakesTheConfiguredAction) {
  for (const auto& [action, state] : {std::pair{"latch", ArmingState::latched},
                                      {"disarm", ArmingState::disarmed},
                                      {"count", ArmingState::run}}) {
    LoopConfig config;
    config.max_lost_in_a_row = 2;
    config.overrun_action = action;
    LoopBench bench(config);
    bench.run();
    bench.clock.advance_ns(2 * kFakePeriod_ns + 1);
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::run) << action;
    bench.tick();
    bench.clock.advance_ns(3 * kFakePeriod_ns + 1);
    bench.tick();
    EXPECT_EQ(bench.state(), state) << action;
    EXPECT_EQ(bench.last_V() == kFakeNull_V, state != ArmingState::run) << action;
  }
}

TEST(Overrun, ASlowDeviceIsAnOverrunToo) {
  LoopBench bench;
  bench.run();
  bench.rig.read_ns = 2 * kFakePeriod_ns + 1;
  bench.tick();
  bench.rig.read_ns = 0;
  EXPECT_EQ(bench.sample().gap, 2);
  EXPECT_EQ(bench.stats.overruns.value(), 1);
  EXPECT_GE(bench.stats.read.max_ns(), 2 * kFakePeriod_ns + 1);
}

TEST(Loop, WritesNullWhileThePositionIsMissingAndLatchesAfterTooMany) {
  LoopConfig config;
  config.max_bad_in_a_row = 3;
  LoopBench bench(config);
  bench.run();
  for (int k = 0; k < 3; ++k) {
    bench.rig.quality = config::signals::Quality::bad;
    const config::signals::Sample sample = bench.sample();
    EXPECT_EQ(sample.u_applied_V, kFakeNull_V);
    EXPECT_TRUE(std::isnan(sample.y_m)) << "a missing value must not look like a reading";
    EXPECT_EQ(sample.quality, config::signals::Quality::bad);
    EXPECT_EQ(bench.state(), ArmingState::run);
  }
  bench.rig.quality = config::signals::Quality::good;
  EXPECT_NEAR(bench.sample().u_applied_V, kController_V, kRounding_V);
  bench.rig.y_m = std::nan("");  // no number is no reading, whatever the device says of it
  for (int k = 0; k < 4; ++k) bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
  EXPECT_EQ(bench.stats.trip.load(), Trip::reading);
  EXPECT_EQ(bench.stats.rod.bad.value(), 7);
  bench.rig.y_m = 0.1;
  EXPECT_EQ(bench.sample().u_applied_V, kFakeNull_V) << "LATCHED stays so until a reset";
}

TEST(Loop, LatchesWhenTheValveCannotBeWritten) {
  LoopConfig config;
  config.max_bad_in_a_row = 1;
  LoopBench bench(config);
  bench.run();
  bench.rig.write_good = false;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::run);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
  EXPECT_EQ(bench.stats.trip.load(), Trip::write);
  bench.tick();
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
}

// A bus that is lost takes position and e-stop away in the same period as the valve.
TEST(Loop, NamesTheLostBusAsTheCauseNotWhatCannotBeReadWithoutIt) {
  for (const int max_bad : {0, 1, 3}) {
    for (const bool write_fails : {true, false}) {
      LoopConfig config;
      config.max_bad_in_a_row = max_bad;
      LoopBench bench(config);
      const auto e_stop = std::make_shared<FakeInput>(1.0);
      bench.inputs.push_back({"stop", hal::InputRole::e_stop, e_stop});
      bench.run();
      ASSERT_EQ(bench.state(), ArmingState::run);
      e_stop->quality = bench.rig.quality = config::signals::Quality::bad;
      bench.rig.write_good = !write_fails;
      for (int i = 0; i < max_bad + 3; ++i) bench.tick();
      EXPECT_EQ(bench.state(), ArmingState::latched);
      EXPECT_EQ(bench.stats.trip.load(), write_fails ? Trip::write : Trip::e_stop_unread);
      EXPECT_EQ(bench.stats.trip_guard.load(),
                static_cast<int>(write_fails ? control::GuardKind::bus_lost
                                             : control::GuardKind::e_stop));
    }
  }
}

TEST(Loop, KeepsThePressedEmergencyStopAsTheCauseWhenTheBusIsLostLater) {
  LoopConfig config;
  config.max_bad_in_a_row = 1;
  LoopBench bench(config);
  const auto e_stop = std::make_shared<FakeInput>(1.0);
  bench.inputs.push_back({"stop", hal::InputRole::e_stop, e_stop});
  bench.run();
  e_stop->value = 0.0;
  bench.tick();
  bench.rig.write_good = false;
  for (int i = 0; i < 5; ++i) bench.tick();
  EXPECT_EQ(bench.stats.trip.load(), Trip::e_stop);
}

TEST(Loop, ResetLeadsToDisarmedNotBackToMotion) {
  LoopConfig config;
  config.max_bad_in_a_row = 0;
  LoopBench bench(config);
  bench.run();
  bench.rig.quality = config::signals::Quality::bad;
  bench.tick();
  ASSERT_EQ(bench.state(), ArmingState::latched);
  bench.rig.quality = config::signals::Quality::good;
  bench.command(Event::reset);
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
  EXPECT_EQ(bench.stats.trip.load(), Trip::none);
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
}

TEST(Loop, ClosingWritesNullWhateverIsOrdered) {
  LoopBench bench;
  bench.run();
  bench.loop().close();
  for (int k = 0; k < 3; ++k) {
    bench.command(Event::arm);
    bench.command(Event::start);
    EXPECT_EQ(bench.sample().u_applied_V, kFakeNull_V);
    EXPECT_EQ(bench.state(), ArmingState::disarmed);
  }
}

}  // namespace
}  // namespace monitor::rt
