// Every guard alone, against motions whose crossing times are known in closed form.
#include "daemon/control/guard_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "config/schema/error.h"

namespace monitor::control {
namespace {

constexpr double kTs_s = 0.005;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

GuardConfig guard(const char* kind, const char* action = "latch") {
  GuardConfig config;
  config.id = config.kind = kind;
  config.action = action;
  return config;
}

GuardMonitor monitor_of(const std::vector<GuardConfig>& guards) {
  SafetyConfig config;
  config.guards = guards;
  return {all_guards(config, Action::latch), kTs_s};
}

/// Tick at which the guard first asks for its action, -1: never within 1,000 ticks.
int first_trip(const GuardConfig& config, const std::function<GuardInputs(double t_s)>& inputs) {
  GuardMonitor monitor = monitor_of({config});
  for (int k = 0; k < 1000; ++k) {
    GuardInputs now = inputs(k * kTs_s);
    now.t_s = k * kTs_s;
    const GuardTrip trip = monitor.watch(now);
    if (trip.action != Action::none) {
      EXPECT_EQ(trip.guard, static_cast<int>(kBuiltIn));
      EXPECT_EQ(trip.action, action_of(config.action));
      return k;
    }
  }
  return -1;
}

GuardInputs at(double y_m) {
  GuardInputs inputs;
  inputs.y_m = y_m;
  return inputs;
}

/// First whole tick at or after t_s.
int tick_of(double t_s) { return static_cast<int>(std::ceil(t_s / kTs_s - 1e-9)); }

TEST(Guard, TravelTripsAtTheFirstTickBeyondALimitOnEitherSide) {
  GuardConfig travel = guard("travel");
  travel.low_m = 0.1;
  travel.high_m = 0.3;
  const double v_mps = 0.0503;
  EXPECT_EQ(first_trip(travel, [&](double t) { return at(0.2 + v_mps * t); }),
            tick_of(0.1 / v_mps));
  EXPECT_EQ(first_trip(travel, [&](double t) { return at(0.2 - v_mps * t); }),
            tick_of(0.1 / v_mps));
  EXPECT_EQ(first_trip(travel, [](double) { return at(0.3); }), -1) << "the limit is inside";
}

TEST(Guard, TravelCountsTheWayThatBrakingTakes) {
  GuardConfig travel = guard("travel");
  travel.high_m = 0.3003;
  travel.braking_mps2 = 2.0;
  const double v_mps = 0.2;  // stops within v^2 / 2a = 10 mm
  EXPECT_EQ(first_trip(travel, [&](double t) { return at(0.1 + v_mps * t); }),
            tick_of((0.3003 - 0.01 - 0.1) / v_mps));
  EXPECT_EQ(first_trip(travel, [&](double t) { return at(0.295 - v_mps * t); }), -1)
      << "a rod on its way back is no danger";
}

TEST(Guard, TravelLetsARodComeBackFromOutsideAndThenHoldsItInside) {
  GuardConfig travel = guard("travel");
  travel.high_m = 0.3;
  GuardMonitor monitor = monitor_of({travel});
  monitor.start(0.32);
  GuardInputs inputs = at(0.32);
  const auto verdict_at = [&](double y_m) {
    inputs.t_s += kTs_s;
    inputs.y_m = y_m;
    return monitor.watch(inputs).action;
  };
  EXPECT_EQ(verdict_at(0.3205), Action::none) << "the jerk of a start";
  EXPECT_EQ(verdict_at(0.31), Action::none);
  EXPECT_EQ(verdict_at(0.299), Action::none);
  EXPECT_EQ(verdict_at(0.301), Action::latch) << "inside once, the limit counts again";
  monitor.start(0.32);
  EXPECT_EQ(verdict_at(0.3215), Action::latch) << "further out is no way back";
}

TEST(Guard, FollowingTripsWhenTheErrorHasLasted) {
  GuardConfig following = guard("following", "hold");
  following.limit_m = 0.0101;
  following.time_s = 0.1;
  // |r - y| = 0.05 t passes 10.1 mm at 0.202 s and has lasted 0.1 s after the tick that sees it.
  const auto drift = [](double t) {
    GuardInputs inputs = at(0.2);
    inputs.reference_m = 0.2 + 0.05 * t;
    return inputs;
  };
  EXPECT_EQ(first_trip(following, drift), tick_of(0.202) + tick_of(0.1));
  EXPECT_EQ(first_trip(following,
                       [](double t) {
                         GuardInputs inputs = at(0.2);
                         inputs.reference_m = std::fmod(t, 0.1) < 0.09 ? 0.25 : 0.2;
                         return inputs;
                       }),
            -1)
      << "an error that goes away in between has not lasted";
  EXPECT_EQ(first_trip(following, [](double) { return at(0.2); }), -1) << "no reference";
}

TEST(Guard, SpeedIsThatBetweenReadingsAlsoAcrossMissingOnes) {
  GuardConfig speed = guard("speed");
  speed.limit_mps = 0.1;
  // y = a t^2 / 2 with a = 0.5: the mean speed of a period ending at t is a (t - Ts / 2).
  EXPECT_EQ(first_trip(speed, [](double t) { return at(0.25 * t * t); }),
            tick_of(0.2 + kTs_s / 2.0));
  EXPECT_EQ(first_trip(speed,
                       [](double t) {
                         const bool gap = t > 0.1 && t < 0.2;
                         return at(gap ? kNaN : 0.09 * t);
                       }),
            -1);
}

TEST(Guard, StaleIsAnAgeOrASensorsOwnWord) {
  GuardConfig stale = guard("stale", "ramp");
  stale.age_s = 0.0202;
  EXPECT_EQ(first_trip(stale,
                       [](double t) {
                         GuardInputs inputs = at(0.2);
                         inputs.age_s = 0.1 * t;
                         return inputs;
                       }),
            tick_of(0.202));
  EXPECT_EQ(first_trip(stale,
                       [](double t) {
                         GuardInputs inputs = at(0.2);
                         inputs.called_stale = t >= 0.5;
                         return inputs;
                       }),
            tick_of(0.5));
}

TEST(Guard, FrozenNeedsACommandThatLastsAndARodThatDoesNot) {
  GuardConfig frozen = guard("frozen");
  frozen.least_m = 1e-4;
  frozen.command_V = 0.5;
  frozen.time_s = 0.25;
  const auto inputs = [](double y_m, double u_V) {
    GuardInputs f = at(y_m);
    f.command_V = u_V;
    return f;
  };
  EXPECT_EQ(first_trip(frozen, [&](double) { return inputs(0.2, -1.0); }), tick_of(0.25));
  EXPECT_EQ(first_trip(frozen, [&](double) { return inputs(0.2, 0.4); }), -1);
  // 1 mm/s passes least_m every 0.1 s; a tenth of it only every second.
  EXPECT_EQ(first_trip(frozen, [&](double t) { return inputs(1e-3 * t, 1.0); }), -1);
  EXPECT_EQ(first_trip(frozen, [&](double t) { return inputs(1e-4 * t, 1.0); }), tick_of(0.25));
  EXPECT_EQ(
      first_trip(frozen, [&](double t) { return inputs(0.2, std::sin(2.0 * M_PI * t / 0.4)); }), -1)
      << "a command that changes its sign need not move the rod";
}

TEST(Guard, JumpIsPerPeriodAndNotOfARodThatMovedWhileUnseen) {
  GuardConfig jump = guard("jump");
  jump.limit_m = 1e-3;
  EXPECT_EQ(first_trip(jump, [](double t) { return at(t >= 0.3 ? 0.2015 : 0.2); }), tick_of(0.3));
  EXPECT_EQ(first_trip(jump,
                       [](double t) {
                         const bool gap = t > 0.1 && t < 0.2;
                         return at(gap ? kNaN : 0.15 * t);
                       }),
            -1)
      << "0.75 mm a period, whatever was missed";
}

TEST(Guard, SaturatedAndDisagreeTripWhenTheyHaveLasted) {
  GuardConfig saturated = guard("saturated", "indicate");
  saturated.time_s = 0.5;
  EXPECT_EQ(first_trip(saturated,
                       [](double t) {
                         GuardInputs inputs = at(0.2);
                         inputs.saturated = t >= 1.0;
                         return inputs;
                       }),
            tick_of(1.5));
  GuardConfig disagree = guard("disagree", "ramp");
  disagree.tolerance_m = 2.02e-3;
  EXPECT_EQ(first_trip(disagree,
                       [](double t) {
                         GuardInputs inputs = at(0.2);
                         inputs.spare_difference_m = 0.01 * t;
                         return inputs;
                       }),
            tick_of(0.202));
}

GuardInputs with_pressures(double supply_Pa, double in_Pa, double out_Pa, bool runs = true) {
  GuardInputs inputs = at(0.2);
  inputs.pressures = {supply_Pa, in_Pa, out_Pa};
  if (runs) inputs.reference_m = 0.2;
  return inputs;
}

TEST(Guard, PressureTripsBelowAndAboveItsLimitsInRunOnly) {
  GuardConfig low = guard("pressure");
  low.channel = "supply_pressure";
  low.low_Pa = 50e5;
  low.high_Pa = 200e5;
  low.time_s = 0.1;
  const auto falls = [](bool runs) {
    return [runs](double t) { return with_pressures(100e5 - 40e5 * t, 50e5, 50e5, runs); };
  };
  EXPECT_EQ(first_trip(low, falls(true)), tick_of(1.25) + 1 + tick_of(0.1));
  EXPECT_EQ(first_trip(low, falls(false)), -1) << "the pump may be off at rest";
  GuardConfig high = guard("pressure");
  high.channel = "pressure_out";
  high.high_Pa = 150e5;
  EXPECT_EQ(first_trip(high, [](double t) { return with_pressures(200e5, 0.0, 100e5 * t); }),
            tick_of(1.5) + 1);
  EXPECT_EQ(first_trip(high, [](double) { return with_pressures(kNaN, kNaN, kNaN); }), -1)
      << "what cannot be read is the transducer's";
}

TEST(Guard, TransducerTripsWhileItsPressureCannotBeReadAtRestToo) {
  GuardConfig lost = guard("transducer", "indicate");
  lost.channel = "pressure_in";
  lost.time_s = 0.05;
  EXPECT_EQ(
      first_trip(
          lost, [](double t) { return with_pressures(100e5, t < 1.0 ? 50e5 : kNaN, 50e5, false); }),
      tick_of(1.0) + tick_of(0.05));
}

TEST(Guard, ChambersTripWhenOneIsAboveTheSupplyOrBelowNothing) {
  GuardConfig chambers = guard("chambers");
  chambers.tolerance_Pa = 5e5;
  EXPECT_EQ(
      first_trip(chambers, [](double t) { return with_pressures(100e5, 100e5 + 10e5 * t, 0); }),
      tick_of(0.5) + 1);
  EXPECT_EQ(first_trip(chambers, [](double t) { return with_pressures(kNaN, -10e5 * t, 0); }),
            tick_of(0.5) + 1);
  EXPECT_EQ(first_trip(chambers, [](double) { return with_pressures(100e5, 104e5, kNaN); }), -1);
}

TEST(GuardMonitor, TheStrongestActionOfATickWinsAndEachIsAskedForOnce) {
  GuardConfig speed = guard("speed", "hold");
  speed.limit_mps = 0.1;
  GuardConfig jump = guard("jump", "latch");
  jump.limit_m = 1e-3;
  GuardMonitor monitor = monitor_of({speed, jump});
  GuardInputs inputs = at(0.2);
  EXPECT_EQ(monitor.watch(inputs).action, Action::none);
  inputs.t_s = kTs_s;
  inputs.y_m = 0.21;
  const GuardTrip trip = monitor.watch(inputs);
  EXPECT_EQ(trip.action, Action::latch);
  EXPECT_EQ(trip.guard, static_cast<int>(kBuiltIn) + 1);
  inputs.t_s = 2 * kTs_s;
  inputs.y_m = 0.22;
  EXPECT_EQ(monitor.watch(inputs).action, Action::none) << "still active, but not anew";
  EXPECT_TRUE(monitor.guards()[kBuiltIn].active());
}

TEST(GuardMonitor, SaysWhichGuardForbidsToArm) {
  GuardConfig disagree = guard("disagree", "latch");
  disagree.tolerance_m = 1e-3;
  GuardMonitor monitor = monitor_of({disagree, guard("travel")});
  EXPECT_EQ(monitor.obstacle(), -1);
  GuardInputs inputs = at(0.2);
  inputs.spare_difference_m = 1.0;
  monitor.watch(inputs);
  EXPECT_EQ(monitor.obstacle(), static_cast<int>(kBuiltIn));
  EXPECT_EQ(monitor.set(GuardKind::e_stop, true, 0.0).action, Action::latch);
  EXPECT_EQ(monitor.obstacle(), static_cast<int>(GuardKind::e_stop));
  EXPECT_EQ(monitor.set(GuardKind::e_stop, false, 0.0).action, Action::none);
}

TEST(Guards, BuiltInOnesAreThereWithoutAnEntryAndTakeTheActionOfOne) {
  SafetyConfig config;
  EXPECT_EQ(all_guards(config, Action::disarm).size(), kBuiltIn);
  EXPECT_EQ(all_guards(config, Action::disarm)[3].action, "disarm");
  config.guards = {guard("overrun", "hold"), guard("travel")};
  const auto all = all_guards(config, Action::latch);
  ASSERT_EQ(all.size(), kBuiltIn + 1);
  EXPECT_EQ(all[3].action, "hold");
  EXPECT_EQ(all[0].action, "latch");
}

TEST(Guards, RefusesTwoOfOneIdTwoOfABuiltInKindAndTooMany) {
  SafetyConfig config;
  config.guards = {guard("travel"), guard("travel")};
  EXPECT_THROW((void)all_guards(config, Action::latch), config::schema::Error);
  config.guards = {guard("e_stop"), guard("e_stop", "ramp")};
  config.guards[1].id = "other";
  EXPECT_THROW((void)all_guards(config, Action::latch), config::schema::Error);
  config.guards.assign(kMaxGuards, guard("travel"));
  for (std::size_t i = 0; i < config.guards.size(); ++i) config.guards[i].id = std::to_string(i);
  EXPECT_THROW((void)all_guards(config, Action::latch), config::schema::Error);
}

}  // namespace
}  // namespace monitor::control
