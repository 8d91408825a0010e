// A rod sensor fails in RUN on the simulated rig, in virtual time: who goes on, how far the rod
// goes astray, and what happens when the next one fails too. Truth: the same run with every sensor
// healthy.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "daemon/rt/loop.h"
#include "hal/sim/sim.h"
#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::ArmingState;
using control::RodFault;
using hal::sim::InjectedFault;

constexpr double kTs_s = 0.005;
constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr double kCentre_m = 0.305;
constexpr double kAmplitude_m = 0.0254;
constexpr double kTravel_m = 0.028;  ///< either side of the centre; the healthy rod has 26 mm
constexpr double kBlend_mps = 0.05;
constexpr double kGain_V_per_m = 250.0;

control::GuardConfig guard(const char* kind) {
  control::GuardConfig config;
  config.id = config.kind = kind;
  return config;
}

SafetyRules rules() {
  SafetyRules rules;
  control::FailoverConfig& failover = rules.safety.failover;
  failover.present = true;
  failover.tolerance_m = 0.5e-3;
  rules.safety.blend_mps = kBlend_mps;
  control::GuardConfig travel = guard("travel");
  travel.low_m = kCentre_m - kTravel_m;
  travel.high_m = kCentre_m + kTravel_m;
  control::GuardConfig frozen = guard("frozen");
  frozen.least_m = 1e-4;
  frozen.command_V = 0.3;
  frozen.time_s = 0.05;
  control::GuardConfig jump = guard("jump");
  jump.limit_m = 2e-3;
  control::GuardConfig following = guard("following");
  following.limit_m = 0.02;
  rules.safety.guards = {travel, frozen, jump, following};
  return rules;
}

InjectedFault fault(const char* kind, double from_s, const char* rod = "") {
  InjectedFault fault;
  fault.kind = kind;
  fault.rod = rod;
  fault.from_s = from_s;
  return fault;
}

/// Eight seconds of the sine with `rods` sensors; the spare ones have an offset of 0.2 mm and
/// noise of their own.
class Course {
 public:
  Course(std::size_t rods, const std::vector<InjectedFault>& injected_faults,
         double offset_m = 2e-4) {
    hal::sim::SimConfig config;
    config.noise_m = 2e-6;
    config.injected_faults = injected_faults;
    rig_ = std::make_shared<hal::sim::SimRig>(plant_sim::make_plant(plant_sim::ModelFile()), config,
                                              kTs_s, 0.0);
    std::vector<hal::NamedRod> spares;
    for (std::size_t i = 1; i < rods; ++i) {
      hal::sim::SpareConfig spare;
      spare.id = i == 1 ? "b" : "c";
      spare.offset_m = offset_m;
      spare.noise_m = 5e-6;
      spares.push_back(
          {spare.id, std::make_shared<hal::sim::SpareRod>(rig_, spare, injected_faults, 1 + i)});
    }
    VirtualClock clock;
    const control::Sine reference(kCentre_m, kAmplitude_m, 0.5);
    const auto queue = std::make_unique<SampleQueue>();
    CommandQueue commands;
    Loop loop({}, {clock, *rig_, rig_.get(), reference, *queue, commands, stats, &spares},
              control::Controller({kGain_V_per_m}, {0.0, 10.0, 1000.0}, kTs_s), kTs_s, rules());
    Grid grid(0, kPeriod_ns);
    for (const control::Event event : {control::Event::arm, control::Event::start}) {
      LoopCommand command;
      command.event = event;
      command.expires_ns = INT64_MAX;
      commands.push(command);
    }
    config::signals::Sample sample;
    while (grid_ticks_ < 1600) {
      ++grid_ticks_;
      loop.tick(grid.next(clock));
      queue->pop(sample);
      samples.push_back(sample);
      position_m.push_back(rig_->position_m());
    }
  }
  /// Greatest distance between the rods of two courses.
  [[nodiscard]] double astray_m(const Course& healthy) const {
    double worst_m = 0.0;
    for (std::size_t k = 0; k < position_m.size(); ++k) {
      worst_m = std::max(worst_m, std::abs(position_m[k] - healthy.position_m[k]));
    }
    return worst_m;
  }
  /// Tick of the first sample with that sensor out, -1: none.
  [[nodiscard]] std::int64_t out(std::size_t rod) const {
    for (const auto& sample : samples) {
      if (sample.rod_fault[rod] != 0) return sample.tick;
    }
    return -1;
  }
  /// Greatest change of the command within one tick, from a tick on.
  [[nodiscard]] double kick_V(std::size_t from, std::size_t to) const {
    double worst_V = 0.0;
    for (std::size_t k = from; k < to; ++k) {
      worst_V = std::max(worst_V, std::abs(samples[k].u_applied_V - samples[k - 1].u_applied_V));
    }
    return worst_V;
  }

  LoopStats stats;
  std::vector<config::signals::Sample> samples;
  std::vector<double> position_m;

 private:
  std::shared_ptr<hal::sim::SimRig> rig_;
  int grid_ticks_ = 0;
};

struct Case {
  InjectedFault injected;
  RodFault fault;
  double delay_s;   ///< longest of the fail-over
  double astray_m;  ///< farthest of the rod
};

/// At 5 s the rod is on its way through the centre at full speed, 80 mm/s.
constexpr double kFault_s = 5.0;
constexpr std::size_t kFaultTick = 1000;

class Failover : public testing::TestWithParam<Case> {};

TEST_P(Failover, LetsTheControllerGoOnWithTheNextSensor) {
  const Case& c = GetParam();
  const Course healthy(3, {});
  ASSERT_EQ(healthy.stats.state.load(), ArmingState::run);
  ASSERT_EQ(healthy.out(0), -1);
  const Course course(3, {c.injected});
  EXPECT_EQ(course.stats.state.load(), ArmingState::run) << "no guard trips";
  EXPECT_EQ(course.stats.rods[0].fault.load(), c.fault);
  EXPECT_EQ(course.stats.rod_in_charge.load(), 1);
  const std::int64_t out = course.out(0);
  ASSERT_GE(out, static_cast<std::int64_t>(kFaultTick));
  EXPECT_LE(static_cast<double>(out - static_cast<std::int64_t>(kFaultTick)) * kTs_s, c.delay_s);
  EXPECT_EQ(course.stats.rod_since_tick.load(), out);
  EXPECT_EQ(course.out(1), -1);
  EXPECT_EQ(course.out(2), -1);
  EXPECT_LE(course.astray_m(healthy), c.astray_m);
  RecordProperty("astray_um", static_cast<int>(course.astray_m(healthy) * 1e6));
  RecordProperty("delay_ms", static_cast<int>((out - 1000) * 5));
  int changes = 0;
  for (const auto& sample : course.samples) {
    changes += sample.rod_changed ? 1 : 0;
    if (sample.rod_changed) {
      EXPECT_EQ(sample.tick, out);
    }
  }
  EXPECT_EQ(changes, 1);
  for (std::size_t k = kFaultTick; k < course.position_m.size(); ++k) {
    ASSERT_LT(std::abs(course.position_m[k] - kCentre_m), kTravel_m) << k;
  }
}

InjectedFault jump(double size_m) {
  InjectedFault t = fault("jump", kFault_s);
  t.size_m = size_m;
  return t;
}

InjectedFault drift(double rate_mps) {
  InjectedFault t = fault("drift", kFault_s);
  t.rate_mps = rate_mps;
  return t;
}

// The rod ends up at most by the offset of 0.2 mm off its healthy course; besides, until the
// fail-over it goes where a wrong reading sends it: at most at gain x K x error, with K = 0.04
// m/(s V), which is 10 x error a second.
INSTANTIATE_TEST_SUITE_P(
    OfThree, Failover,
    testing::Values(Case{fault("missing", kFault_s), RodFault::missing, 0.0, 0.25e-3},
                    Case{jump(0.01), RodFault::jump, 0.0, 0.25e-3},
                    // 1 mm stays below the jump guard: out-voted after four ticks.
                    Case{jump(0.001), RodFault::outvoted, 0.015, 0.4e-3},
                    // 80 mm/s leave 0.5 mm behind in 7 ms.
                    Case{fault("frozen", kFault_s), RodFault::outvoted, 0.035, 0.6e-3},
                    // 2 mm/s need 0.25 s plus the spares' offset to be off by 0.5 mm.
                    Case{drift(0.002), RodFault::outvoted, 0.4, 1e-3}));

TEST(FailoverOfTwo, NamesTheFrozenSensorSinceTheOtherSawTheRodMove) {
  const Course healthy(2, {});
  const Course course(2, {fault("frozen", kFault_s)});
  EXPECT_EQ(course.stats.state.load(), ArmingState::run);
  EXPECT_EQ(course.stats.rods[0].fault.load(), RodFault::frozen);
  // Frozen for 0.05 s and what least_m takes: 10/s x 80 mm/s x t^2/2 = 1.5 mm, and the offset.
  EXPECT_LE(course.astray_m(healthy), 2e-3);
}

TEST(FailoverOfTwo, DoesNotKickTheValve) {
  constexpr double kOffset_m = 2e-3;
  const Course healthy(2, {}, kOffset_m);
  const Course course(2, {fault("missing", kFault_s)}, kOffset_m);
  // The command goes on as before, and the offset fades at gain x speed; the rest is noise and
  // steps of 5 um at 250 V/m, and those of the D/A converter.
  const double noise_V = kGain_V_per_m * 6.0 * 5e-6 + 2.0 * 20.0 / 4096.0;
  EXPECT_LE(
      course.kick_V(kFaultTick, kFaultTick + 40),
      healthy.kick_V(kFaultTick, kFaultTick + 40) + kGain_V_per_m * kBlend_mps * kTs_s + noise_V);
  EXPECT_EQ(course.out(0), static_cast<std::int64_t>(kFaultTick));
  EXPECT_NEAR(course.position_m.back() - healthy.position_m.back(), -kOffset_m, 2e-5)
      << "in the end the controller holds what the sensor in charge reads";
}

TEST(FailoverOfTwo, GoesBackOnAnOrderOrAStartOnly) {
  SafetyRules rules = without_blending();
  rules.safety.failover.present = true;
  rules.safety.failover.tolerance_m = 1e-3;
  LoopBench bench({}, true, rules);
  const auto spare = std::make_shared<FakeRig>(nullptr);
  bench.spare_rods.push_back({"b", spare});
  bench.run();
  for (const bool by_order : {true, false}) {
    bench.rig.quality = config::signals::Quality::bad;
    const config::signals::Sample without = bench.sample();
    EXPECT_EQ(without.rod_in_charge, 1);
    EXPECT_EQ(without.y_m, 0.1);
    EXPECT_TRUE(std::isnan(without.rod_m[0]));
    EXPECT_EQ(without.rod_quality[0], config::signals::Quality::bad);
    bench.rig.quality = config::signals::Quality::good;
    for (int k = 0; k < 1000; ++k) bench.tick();
    EXPECT_EQ(bench.stats.rod_in_charge.load(), 1);
    if (by_order) {
      LoopCommand command;
      command.kind = LoopCommand::Kind::readmit;
      command.expires_ns = INT64_MAX;
      bench.commands.push(command);
    } else {
      bench.command(control::Event::stop);
      bench.command(control::Event::start);
    }
    bench.tick();
    bench.tick();
    EXPECT_EQ(bench.stats.rod_in_charge.load(), 0) << by_order;
    EXPECT_EQ(bench.stats.rods[0].fault.load(), RodFault::none);
  }
  EXPECT_EQ(bench.state(), ArmingState::run);
}

TEST(FailoverOfTwo, ASecondFailureIsTheGuards) {
  for (const char* kind : {"missing", "frozen", "jump"}) {
    InjectedFault second = fault(kind, kFault_s + 1.0, "b");
    second.size_m = 0.01;
    const Course course(2, {fault("missing", kFault_s), second});
    EXPECT_EQ(course.stats.state.load(), ArmingState::latched) << kind;
    EXPECT_EQ(course.samples[kFaultTick + 190].state, static_cast<std::uint8_t>(ArmingState::run));
    EXPECT_EQ(course.samples.back().u_applied_V, 0.0) << "null";
  }
}

}  // namespace
}  // namespace monitor::rt
