// Proof that a tick allocates nothing.
#include <gtest/gtest.h>

#include <cstddef>

#include "daemon/rt/loop.h"
#include "hal/replay/replay.h"
#include "hal/sim/sim.h"
#include "tests/count_allocations.h"

namespace monitor::rt {
namespace {

constexpr double kTs_s = 0.005;
constexpr std::int64_t kPeriod_ns = 5'000'000;

/// Allocations of 4,000 ticks, overruns and commands among them.
long allocations_of_ticks(hal::RodSensor& rod, hal::ValveDrive* valve,
                          const control::Reference& reference) {
  VirtualClock clock;
  SampleQueue samples;
  CommandQueue commands;
  LoopStats stats;
  Loop loop({}, {clock, rod, valve, reference, samples, commands, stats},
            control::Controller({250.0}, {0.0, 10.0, 1000.0}, kTs_s), kTs_s);
  Grid grid(0, kPeriod_ns);
  const long before = allocations;
  for (int n = 0; n < 4000; ++n) {
    Command command;
    command.event = n % 500 == 1 ? control::Event::arm : control::Event::start;
    command.expires_ns = clock.now_ns() + 2 * kPeriod_ns;
    if (n % 500 < 3) commands.push(command);
    if (n % 100 == 99) clock.advance_ns((n / 100) * kPeriod_ns / 2);
    if (!loop.tick(grid.next(clock))) break;
  }
  const long after = allocations;
  EXPECT_GT(stats.ticks.value(), 3000);
  EXPECT_GT(stats.overruns.value(), 5);
  EXPECT_GT(stats.dropped_samples.value(), 100);
  return after - before;
}

class TickAllocation : public testing::Test {
 protected:
  void SetUp() override {
    if (SPOOLWATCH_COUNTS_MALLOC == 0) GTEST_SKIP() << "the sanitizer owns malloc";
    const long before = allocations;
    auto probe = std::make_unique<std::vector<int>>(10);
    ASSERT_GE(allocations - before, 2) << "the counter does not count";
  }
};

TEST_F(TickAllocation, IsNoneOnTheSimulatedRigWhateverTheMotion) {
  for (const char* kind : {"sine", "multisine", "steps", "chirp", "prbs"}) {
    hal::sim::SimConfig config;
    config.noise_m = 2e-6;
    plant_sim::Change fault;
    fault.parameter = "supply_pressure_Pa";
    fault.at_s = 3.0;
    fault.factor = 0.8;
    fault.ramp_s = 2.0;
    config.faults = {fault};
    hal::sim::SimRig rig(plant_sim::make_plant(plant_sim::ModelFile()), config, kTs_s, 0.0);
    control::ReferenceConfig reference;
    reference.kind = kind;
    EXPECT_EQ(allocations_of_ticks(rig, &rig, *control::make_reference(reference)), 0) << kind;
  }
}

TEST_F(TickAllocation, IsNoneOnAReplayedRecord) {
  config::record::Record record;
  record.sample_time_s = kTs_s;
  for (int i = 0; i < 5000; ++i) {
    record.t_s.push_back(i * kTs_s);
    record.u_V.push_back(0.1);
    record.y_m.push_back(0.2);
  }
  hal::replay::ReplaySensor sensor(record);
  EXPECT_EQ(allocations_of_ticks(sensor, nullptr, control::Sine(0.0, 0.0, 0.0)), 0);
}

}  // namespace
}  // namespace monitor::rt
