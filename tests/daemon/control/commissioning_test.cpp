// The procedure against a servo in closed form: what it finds, and which sign it refuses.
#include "daemon/control/commissioning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "tests/count_allocations.h"
#include "tests/daemon/control/commissioning_servo.h"

namespace monitor::control {
namespace {

using namespace commissioning_test;

/// Speeds: the slope of a line through some 24 readings over 0.12 s with 2.5 um of noise and
/// rounding is good to 15 um/s, 0.3 % of the slower speeds; the lag leaves exp(-0.08 / 0.01).
constexpr double kGainTolerance = 0.02;

struct Case {
  std::string name;
  Servo servo;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Healthy : public testing::TestWithParam<Case> {};

TEST_P(Healthy, GivesBackWhatTheServoIsMadeOfWithinTheTravel) {
  Servo servo = GetParam().servo;
  CommissioningLimits limits;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_speeds(procedure, servo), Failure::none)
      << to_string(procedure.failure()) << ", travel " << procedure.travel_m();
  const Findings& found = procedure.findings();
  EXPECT_GT(found.sign_m * found.sign_V, 0.0);
  const double gain_mps_per_V = servo.gain_mps_per_V * 0.5 * (1.0 + servo.down_ratio);
  EXPECT_NEAR(found.gain_mps_per_V, gain_mps_per_V, kGainTolerance * gain_mps_per_V);
  // A speed wrong by 60 um/s shifts the line by as much over the gain; twice that for either end.
  const double volts = 2.0 * 60e-6 / servo.gain_mps_per_V + 0.005 * servo.dead_zone_V;
  EXPECT_NEAR(found.null_V, servo.null_V, volts);
  EXPECT_NEAR(found.dead_zone_V, servo.dead_zone_V, 2.0 * volts);
  EXPECT_NEAR(found.latency_s, servo.delay_s + servo.lag_s, kLatencyTolerance_s);
  EXPECT_LT(servo.farthest_m, limits.max_travel_m);
  EXPECT_LE(servo.highest_V, limits.authority_V);
}

/// Between two doubled levels it goes from standing to too fast.
Servo steep() {
  Servo servo = with(&Servo::dead_zone_V, 0.35);
  servo.gain_mps_per_V = 0.4;
  return servo;
}

/// Upward it takes many more pulses to find the levels than downward.
Servo lopsided() {
  Servo servo = steep();
  servo.down_ratio = 0.1;
  servo.dead_zone_V = 0.36;
  return servo;
}

Servo null_and_dead_zone() {
  Servo servo = with(&Servo::dead_zone_V, 0.3);
  servo.null_V = 0.08;
  return servo;
}

INSTANTIATE_TEST_SUITE_P(Servos, Healthy,
                         testing::Values(Case{"plain", {}},
                                         Case{"slow", with(&Servo::gain_mps_per_V, 0.008)},
                                         Case{"fast", with(&Servo::gain_mps_per_V, 0.4)},
                                         Case{"null_above", with(&Servo::null_V, 0.08)},
                                         Case{"null_below", with(&Servo::null_V, -0.08)},
                                         Case{"unreliable", with(&Servo::lost, 0.03)},
                                         Case{"dead_zone", with(&Servo::dead_zone_V, 0.4)},
                                         Case{"null_and_dead_zone", null_and_dead_zone()},
                                         Case{"steep", steep()}, Case{"lopsided", lopsided()},
                                         Case{"late", with(&Servo::delay_s, 0.025)},
                                         Case{"no_rounding", with(&Servo::count_m, 0.0)}),
                         [](const auto& each) { return each.param.name; });

TEST(Noise, IsThatOfTheReadingAtRest) {
  Servo servo = with(&Servo::noise_m, 20e-6);
  servo.null_V = 0.02;  // and a drift of 0.9 mm/s
  Commissioning procedure({});
  procedure.begin(Stage::rest);
  run(procedure, servo);
  // 60 readings: 1/sqrt(2 * 58) = 9 % standard error, three of them; rounding adds 0.3 %.
  EXPECT_NEAR(procedure.findings().noise_m, 20e-6, 0.28 * 20e-6);
  EXPECT_NEAR(procedure.findings().drift_mps, -0.02 * 0.045, 1e-4);
}

TEST(ReversedSign, IsCaughtAtTheFirstMotionWhicheverIsReversed) {
  for (const auto flipped : {&Servo::valve_sign, &Servo::encoder_sign}) {
    Servo servo = with(flipped, -1.0);
    CommissioningLimits limits;
    Commissioning procedure(limits);
    EXPECT_EQ(up_to_sign(procedure, servo), Failure::reversed);
    // 0.04 of the travel shows it; the rod goes on for the latency.
    EXPECT_LT(servo.farthest_m, 0.3 * limits.max_travel_m);
    EXPECT_LT(procedure.findings().sign_m * procedure.findings().sign_V, 0.0);
  }
}

TEST(ReversedSign, OfBothIsASignThatFits) {
  Servo servo;
  servo.valve_sign = servo.encoder_sign = -1.0;
  Commissioning procedure({});
  EXPECT_EQ(up_to_sign(procedure, servo), Failure::none);
}

TEST(AnyServo, StaysWithinTheTravelAndIsFoundOrGivenUp) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int healthy = 0;
  int found = 0;
  for (int n = 0; n < 400; ++n) {
    Servo servo;
    servo.gain_mps_per_V = std::exp(between(std::log(0.01), std::log(0.5)));
    servo.dead_zone_V = between(0.0, 0.6);
    // The drift at the commanded null is up to 4 mm/s, what a stage of 5 mm can stand.
    servo.null_V = between(-1.0, 1.0) * (0.5 * servo.dead_zone_V + 0.004 / servo.gain_mps_per_V);
    servo.null_V = std::clamp(servo.null_V, -0.2, 0.2);
    servo.delay_s = between(0.001, 0.025);
    servo.lag_s = between(0.002, 0.015);
    servo.down_ratio = std::exp(between(std::log(0.5), std::log(2.0)));
    servo.noise_m = between(0.0, 5e-6);
    servo.valve_sign = between(0.0, 1.0) < 0.25 ? -1.0 : 1.0;
    servo.random.seed(static_cast<unsigned>(n));
    CommissioningLimits limits;
    Commissioning procedure(limits);
    double farthest_m = 0.0;
    Failure failure = Failure::none;
    for (const Stage stage : {Stage::rest, Stage::sign, Stage::speeds}) {
      procedure.begin(stage);
      servo.from_m = servo.y_m;
      servo.farthest_m = 0.0;
      while (!procedure.over()) tick(procedure, servo);
      farthest_m = std::max(farthest_m, servo.farthest_m);
      failure = procedure.failure();
      if (failure != Failure::none) break;
    }
    EXPECT_LT(farthest_m, limits.max_travel_m) << "servo " << n;
    if (servo.valve_sign < 0.0) {
      EXPECT_TRUE(failure == Failure::reversed || failure == Failure::travel)
          << "servo " << n << ": " << to_string(failure);
      continue;
    }
    ++healthy;
    if (failure != Failure::none) continue;
    ++found;
    const double gain_mps_per_V = servo.gain_mps_per_V * 0.5 * (1.0 + servo.down_ratio);
    EXPECT_NEAR(procedure.findings().gain_mps_per_V, gain_mps_per_V, 0.05 * gain_mps_per_V)
        << "servo " << n;
  }
  // Given up are steep ones behind a wide dead zone and slow ones that drift.
  EXPECT_GE(found, 95 * healthy / 100) << "of " << healthy;
}

TEST(RealTime, NoTickAllocates) {
  Servo servo = with(&Servo::dead_zone_V, 0.2);
  servo.stop_high_m = 0.32;
  Commissioning procedure({});
  long taken = 0;
  for (const Stage stage : {Stage::rest, Stage::sign, Stage::speeds, Stage::home}) {
    stage == Stage::home ? procedure.begin_home(1, false) : procedure.begin(stage);
    while (!procedure.over()) {
      Commissioning::Input in;
      in.now_s = in.t_s = servo.t_s;
      in.usable = true;
      in.y_m = servo.read();
      const long before = allocations;
      const double u_V = procedure.step(in);
      taken += allocations - before;
      servo.hold(u_V, kTs_s);
    }
    ASSERT_EQ(procedure.failure(), Failure::none);
  }
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace monitor::control
