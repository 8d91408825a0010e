// Guards in the loop: what is written, where it leads, and the permit.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::ArmingState;
using control::Event;
using control::RejectReason;

control::GuardConfig guard(const char* kind, const char* action) {
  control::GuardConfig config;
  config.id = config.kind = kind;
  config.action = action;
  return config;
}

control::GuardConfig travel_to(double high_m, const char* action) {
  control::GuardConfig config = guard("travel", action);
  config.high_m = high_m;
  return config;
}

SafetyRules rules_of(const std::vector<control::GuardConfig>& guards) {
  SafetyRules rules = without_blending();
  rules.safety.guards = guards;
  return rules;
}

TEST(Hold, FreezesTheReferenceWhereTheRodIsAndAStartResumes) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "hold")}));
  bench.run();
  bench.rig.y_m = 0.21;
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.21);
  bench.rig.y_m = 0.19;
  const config::signals::Sample sample = bench.sample();
  EXPECT_DOUBLE_EQ(sample.reference_m, 0.21) << "held, not following the rod";
  EXPECT_NEAR(sample.u_applied_V, kFakeNull_V + 100.0 * 0.02, kRounding_V) << "the law goes on";
  EXPECT_TRUE(bench.stats.holding.load());
  EXPECT_EQ(bench.state(), ArmingState::run);
  EXPECT_EQ(ask(bench, Event::start).reject_reason, RejectReason::none);
  EXPECT_FALSE(bench.stats.holding.load());
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.3);
}

TEST(Hold, HoldsAgainWhenAnotherReferenceLeadsFurtherOut) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "hold")}));
  bench.run();
  bench.rig.y_m = 0.21;
  bench.tick();
  ASSERT_TRUE(bench.stats.holding.load());
  LoopCommand command;
  command.kind = LoopCommand::Kind::sine;
  command.centre_m = 0.5;
  command.expires_ns = INT64_MAX;
  bench.commands.push(command);
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.5);
  bench.rig.y_m = 0.2115;
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.2115);
  EXPECT_TRUE(bench.stats.holding.load());
}

TEST(Hold, CanBeOrderedInRunOnly) {
  LoopBench bench;
  LoopCommand command;
  command.kind = LoopCommand::Kind::hold;
  command.expires_ns = INT64_MAX;
  command.number = 3;
  bench.commands.push(command);
  bench.tick();
  EXPECT_EQ(control::unpack(bench.stats.answer.load()).reject_reason, RejectReason::state);
  bench.run();
  bench.rig.y_m = 0.17;
  bench.commands.push(command);
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.17);
}

TEST(RampToNull, IsAStraightLineThenDisarmed) {
  SafetyRules rules = rules_of({travel_to(0.2, "ramp")});
  rules.safety.ramp_s = 0.05;  // ten periods
  LoopBench bench({}, true, rules);
  bench.run();
  const double offset_V = bench.last_V() - kFakeNull_V;
  bench.rig.y_m = 0.21;
  for (int k = 0; k < 10; ++k) {
    bench.tick();
    EXPECT_NEAR(bench.last_V(), kFakeNull_V + offset_V * (1.0 - k / 10.0), 1e-9) << k;
    EXPECT_EQ(bench.state(), ArmingState::run);
  }
  bench.tick();
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
}

TEST(RampToNull, GivesWayToALatchAndToAStall) {
  for (const bool stall : {true, false}) {
    SafetyRules rules = rules_of({travel_to(0.2, "ramp"), guard("speed", "latch")});
    rules.safety.guards[1].limit_mps = 100.0;
    LoopBench bench({}, true, rules);
    bench.run();
    bench.rig.y_m = 0.21;
    bench.tick();
    ASSERT_TRUE(bench.stats.ramping.load());
    if (stall) {
      bench.clock.advance_ns(10 * kFakePeriod_ns + 1);
    } else {
      bench.rig.y_m = 2.0;
    }
    bench.tick();
    EXPECT_EQ(bench.last_V(), kFakeNull_V);
    EXPECT_EQ(bench.state(), stall ? ArmingState::disarmed : ArmingState::latched);
  }
}

TEST(Guards, OfMotionActInRunOnlyButShowAlways) {
  LoopBench bench({}, true, rules_of({travel_to(0.05, "latch")}));
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::disarmed);
  EXPECT_EQ(bench.stats.guards.active(), 1U << control::kBuiltIn);
  EXPECT_EQ(bench.stats.guards.take_raised(), 1U << control::kBuiltIn);
  EXPECT_EQ(bench.stats.guards.value(control::kBuiltIn), 0.1);
  bench.run();
  EXPECT_EQ(bench.state(), ArmingState::run) << "a rod outside may come back";
  bench.rig.y_m = 0.11;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
  EXPECT_EQ(bench.stats.trip.load(), Trip::guard);
  EXPECT_EQ(bench.stats.trip_guard.load(), control::kBuiltIn);
}

TEST(Guards, SensorsThatDisagreeForbidToArmAndLatch) {
  SafetyRules rules = rules_of({guard("disagree", "latch")});
  rules.safety.guards[0].tolerance_m = 1e-3;
  LoopBench bench({}, true, rules);
  const auto spare = std::make_shared<FakeRig>(nullptr);
  bench.spare_rods.push_back({"second", spare});
  bench.run();
  EXPECT_EQ(bench.state(), ArmingState::run);
  spare->y_m = 0.1012;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
  bench.command(Event::reset);
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::guard);
  spare->quality = config::signals::Quality::bad;
  bench.tick();
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::none)
      << "a spare without a reading is counted";
  EXPECT_EQ(bench.stats.spare_rods[0].bad.value(), 2);
}

TEST(Guards, StaleIsTheReadingsOwnTime) {
  SafetyRules rules = rules_of({guard("stale", "latch")});
  rules.safety.guards[0].age_s = 0.012;
  LoopBench bench({}, true, rules);
  bench.tick();
  bench.run();
  bench.rig.t_ns = bench.clock.now_ns();
  for (int k = 0; k < 2; ++k) {
    bench.tick();
    EXPECT_EQ(bench.state(), ArmingState::run) << k;
  }
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched) << "15 ms old";
}

TEST(Guards, StaleIsTheSensorsWordWhereTheAgeIsNotKnown) {
  for (const bool known : {true, false}) {
    SafetyRules rules = rules_of({guard("stale", "latch")});
    rules.safety.guards[0].age_s = 1.0;
    LoopBench bench({}, true, rules);
    bench.tick();
    bench.run();
    bench.rig.t_ns = known ? bench.clock.now_ns() : 0;
    bench.rig.quality = config::signals::Quality::stale;
    bench.tick();
    EXPECT_EQ(bench.state(), known ? ArmingState::run : ArmingState::latched);
  }
}

TEST(Guards, OverrunTakesTheActionOfItsEntry) {
  LoopConfig config;
  config.max_lost_in_a_row = 1;
  LoopBench bench(config, true, rules_of({guard("overrun", "hold")}));
  bench.run();
  bench.clock.advance_ns(3 * kFakePeriod_ns + 1);
  bench.rig.y_m = 0.15;
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.15);
  EXPECT_EQ(bench.state(), ArmingState::run);
}

TEST(Start, BeginsWhereTheRodIsAndSoDoesTheLawAfterANull) {
  SafetyRules rules;
  rules.safety.blend_s = 1.0;
  LoopBench bench({}, true, rules);
  bench.run();
  EXPECT_EQ(bench.last_V(), kFakeNull_V) << "no error, no command";
  for (int k = 0; k < 1000; ++k) bench.tick();
  EXPECT_NEAR(bench.last_V(), kController_V, kRounding_V);
  bench.rig.quality = config::signals::Quality::bad;
  bench.tick();
  bench.rig.quality = config::signals::Quality::good;
  EXPECT_DOUBLE_EQ(bench.sample().reference_m, 0.1);
  EXPECT_EQ(bench.last_V(), kFakeNull_V);
}

TEST(Start, NeedsAPosition) {
  LoopBench bench;
  bench.command(Event::arm);
  bench.tick();
  bench.rig.quality = config::signals::Quality::bad;
  EXPECT_EQ(ask(bench, Event::start).reject_reason, RejectReason::position);
}

TEST(Permit, TogglesWithEveryGoodTickAndStopsWithATrip) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "latch")}));
  bench.run();
  for (int k = 0; k < 9; ++k) bench.tick();
  EXPECT_EQ(bench.permit.edges, 10);
  bench.clock.advance_ns(2 * kFakePeriod_ns + 1);
  bench.tick();
  EXPECT_EQ(bench.permit.edges, 10) << "an overrun is no good tick";
  bench.tick();
  EXPECT_EQ(bench.permit.edges, 11);
  bench.rig.y_m = 0.21;
  for (int k = 0; k < 5; ++k) bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
  EXPECT_EQ(bench.permit.edges, 11);
  EXPECT_EQ(bench.stats.permit_good.value(), 11);
}

/// Sends these limits to the loop; returns what the loop did with them in the next tick.
GuardUpdate::Outcome take(LoopBench& bench, const std::vector<control::GuardConfig>& guards,
                          bool loosens, std::int64_t expires_ns = INT64_MAX) {
  const auto all = control::all_guards(rules_of(guards).safety, control::Action::latch);
  GuardUpdate update;
  update.guards = std::vector<control::Guard>(all.begin(), all.end());
  update.loosens = loosens;
  LoopCommand command;
  command.kind = LoopCommand::Kind::guards;
  command.guards = &update;
  command.expires_ns = expires_ns;
  bench.commands.push(command);
  bench.tick();
  return update.outcome.load();
}

TEST(NewLimits, TripInTheSameTickWhereTheyAreTighter) {
  LoopBench bench({}, true, rules_of({travel_to(0.3, "latch")}));
  bench.run();
  bench.rig.y_m = 0.25;
  bench.tick();
  ASSERT_EQ(bench.state(), ArmingState::run);
  EXPECT_EQ(take(bench, {travel_to(0.2, "latch")}, false), GuardUpdate::Outcome::applied);
  EXPECT_EQ(bench.state(), ArmingState::latched);
  EXPECT_DOUBLE_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
}

TEST(NewLimits, ThatLetMorePassAreTakenWhileNothingIsArmed) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "latch")}));
  EXPECT_EQ(take(bench, {travel_to(0.3, "latch")}, true), GuardUpdate::Outcome::applied);
  bench.run();
  bench.rig.y_m = 0.25;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::run);
  bench.rig.y_m = 0.31;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
}

TEST(NewLimits, ThatLetMorePassAreRefusedFromArmedOn) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "latch")}));
  EXPECT_EQ(ask(bench, Event::arm).reject_reason, RejectReason::none);
  EXPECT_EQ(take(bench, {travel_to(0.3, "latch")}, true), GuardUpdate::Outcome::armed);
  EXPECT_EQ(ask(bench, Event::start).reject_reason, RejectReason::none);
  EXPECT_EQ(take(bench, {travel_to(0.3, "latch")}, true), GuardUpdate::Outcome::armed);
  bench.rig.y_m = 0.25;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched) << "the old limit holds";
}

TEST(NewLimits, ThatAreGivenUpChangeNothing) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "latch")}));
  const auto all =
      control::all_guards(rules_of({travel_to(0.3, "latch")}).safety, control::Action::latch);
  GuardUpdate update;
  update.guards = std::vector<control::Guard>(all.begin(), all.end());
  LoopCommand command;
  command.kind = LoopCommand::Kind::guards;
  command.guards = &update;
  command.expires_ns = INT64_MAX;
  bench.commands.push(command);
  ASSERT_TRUE(update.give_up());
  EXPECT_FALSE(update.ended()) << "the loop still holds it";
  bench.tick();
  EXPECT_TRUE(update.ended());
  EXPECT_EQ(update.outcome.load(), GuardUpdate::Outcome::expired);
  bench.run();
  bench.rig.y_m = 0.25;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched) << "the old limit holds";
}

TEST(NewLimits, CannotBeGivenUpOnceTheyAreTaken) {
  GuardUpdate update;
  EXPECT_TRUE(update.begin());
  EXPECT_FALSE(update.give_up());
}

TEST(NewLimits, ThatComeTooLateAreDropped) {
  LoopBench bench({}, true, rules_of({travel_to(0.2, "latch")}));
  bench.tick();
  EXPECT_EQ(take(bench, {travel_to(0.3, "latch")}, true, 1), GuardUpdate::Outcome::expired);
  bench.run();
  bench.rig.y_m = 0.25;
  bench.tick();
  EXPECT_EQ(bench.state(), ArmingState::latched);
}

/// Half of the old time has passed: the new time counts from the same moment.
TEST(NewLimits, KeepHowLongAConditionHasLasted) {
  control::GuardConfig lasting = travel_to(0.2, "latch");
  lasting.time_s = 20 * kFakeSampleTime_s;
  LoopBench bench({}, true, rules_of({lasting}));
  bench.run();
  bench.rig.y_m = 0.25;
  for (int k = 0; k < 10; ++k) bench.tick();
  ASSERT_EQ(bench.state(), ArmingState::run);
  lasting.time_s = 5 * kFakeSampleTime_s;
  EXPECT_EQ(take(bench, {lasting}, false), GuardUpdate::Outcome::applied);
  EXPECT_EQ(bench.state(), ArmingState::latched);
}

}  // namespace
}  // namespace monitor::rt
