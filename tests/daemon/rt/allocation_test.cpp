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

/// Guards of every kind, none of which latches for good while the rod behaves.
SafetyRules every_guard() {
  SafetyRules rules;
  for (const char* kind : {"e_stop", "missing", "bus_lost", "overrun", "travel", "following",
                           "speed", "stale", "frozen", "jump", "saturated", "disagree"}) {
    control::GuardConfig guard;
    guard.id = guard.kind = kind;
    guard.action = rules.safety.guards.size() % 2 == 0 ? "ramp" : "hold";
    guard.time_s = 0.1;
    guard.high_m = 0.32;
    guard.limit_m = 5e-3;
    guard.limit_mps = guard.age_s = guard.command_V = 0.1;
    guard.least_m = guard.tolerance_m = 1e-4;
    rules.safety.guards.push_back(guard);
  }
  rules.safety.failover = {true, 1e-3, 0.02, 0.5};
  return rules;
}

/// The devices around a rod: two spares, a switch of each kind, a permit line.
struct Around {
  explicit Around(const std::shared_ptr<hal::sim::SimRig>& rig) {
    if (rig != nullptr) {
      for (const double offset_m : {0.0, 5e-5}) {
        spares.push_back({"spare", std::make_shared<hal::sim::SpareRod>(
                                       rig, hal::sim::SpareConfig{"", offset_m, 0.0})});
      }
    }
    for (const auto role :
         {hal::InputRole::e_stop, hal::InputRole::enable, hal::InputRole::pressure,
          hal::InputRole::supply_pressure, hal::InputRole::pressure_in, hal::InputRole::other}) {
      hal::sim::SimSwitchConfig config;
      config.from_s = 7.0;  // off for a while
      config.to_s = 7.5;
      inputs.push_back({"input", role, std::make_shared<hal::sim::Switch>(config)});
    }
  }
  std::vector<hal::NamedRod> spares;
  std::vector<hal::NamedInput> inputs;
  hal::sim::CountingLine permit;
};

/// Allocations of 4,000 ticks, overruns and commands among them.
long allocations_of_ticks(hal::RodSensor& rod, hal::ValveDrive* valve,
                          const control::Reference& reference, Around& around) {
  VirtualClock clock;
  SampleQueue samples;
  CommandQueue commands;
  LoopStats stats;
  Loop loop({},
            {clock, rod, valve, reference, samples, commands, stats, &around.spares, &around.inputs,
             &around.permit},
            control::Controller({250.0}, {0.0, 10.0, 1000.0}, kTs_s), kTs_s, every_guard());
  Grid grid(0, kPeriod_ns);
  const long before = allocations;
  for (int n = 0; n < 4000; ++n) {
    LoopCommand command;
    constexpr control::Event kEvents[] = {control::Event::reset, control::Event::arm,
                                          control::Event::start, control::Event::start};
    command.event = kEvents[n % 500 % 4];
    command.number = static_cast<std::uint32_t>(n);
    if (n % 500 == 100) command.kind = LoopCommand::Kind::hold;
    if (n % 500 == 150) command.kind = LoopCommand::Kind::sine;
    command.expires_ns = clock.now_ns() + 2 * kPeriod_ns;
    if (n % 500 < 4 || n % 50 == 0) commands.push(command);
    if (n % 100 == 99) clock.advance_ns((n / 100) * kPeriod_ns / 2);
    if (!loop.tick(grid.next(clock))) break;
  }
  const long after = allocations;
  EXPECT_GT(stats.ticks.value(), 3000);
  EXPECT_GT(stats.overruns.value(), 5);
  EXPECT_GT(stats.dropped_samples.value(), 100);
  EXPECT_GT(around.permit.edges(), 1000);
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
    config.command_timeout_s = 0.1;
    for (const char* injected : {"missing", "frozen", "jump", "drift", "stale", "deaf"}) {
      const double from_s = 8.0 + static_cast<double>(config.injected_faults.size());
      config.injected_faults.push_back({injected, "", from_s, from_s + 0.3, 0.01, 0.01});
    }
    const auto rig = std::make_shared<hal::sim::SimRig>(
        plant_sim::make_plant(plant_sim::ModelFile()), config, kTs_s, 0.0);
    Around around(rig);
    control::ReferenceConfig reference;
    reference.kind = kind;
    EXPECT_EQ(allocations_of_ticks(*rig, rig.get(), *control::make_reference(reference), around), 0)
        << kind;
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
  Around around(nullptr);
  EXPECT_EQ(allocations_of_ticks(sensor, nullptr, control::Sine(0.0, 0.0, 0.0), around), 0);
}

}  // namespace
}  // namespace monitor::rt
