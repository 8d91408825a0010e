// The procedure's reasons to give up, always at null, and its homing.
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/control/commissioning.h"
#include "tests/daemon/control/commissioning_servo.h"

namespace monitor::control {
namespace {

using namespace commissioning_test;

TEST(Trouble, AReversalAfterTheSignIsKnownIsStoppedWithinTheTravel) {
  for (const auto flipped : {&Servo::valve_sign, &Servo::encoder_sign}) {
    Servo servo;
    CommissioningLimits limits;
    Commissioning procedure(limits);
    ASSERT_EQ(up_to_sign(procedure, servo), Failure::none);
    servo.*flipped = -1.0;
    procedure.begin(Stage::speeds);
    run(procedure, servo);
    EXPECT_EQ(procedure.failure(), Failure::wrong_way) << to_string(procedure.failure());
    EXPECT_LT(servo.farthest_m, limits.max_travel_m);
  }
}

TEST(Trouble, AStuckRodOrDeadSensorEndsAtFullAuthorityWithoutMotion) {
  for (const bool stuck : {true, false}) {
    Servo servo;
    servo.stuck = stuck;
    servo.dead_sensor = !stuck;
    CommissioningLimits limits;
    limits.authority_V = 0.5;
    Commissioning procedure(limits);
    EXPECT_EQ(up_to_sign(procedure, servo), Failure::no_motion);
    EXPECT_DOUBLE_EQ(servo.highest_V, limits.authority_V);
    // Blind, a pulse moves the rod by gain, authority and length, and the next moves it back.
    EXPECT_LT(servo.farthest_m,
              servo.gain_mps_per_V * limits.authority_V * (limits.pulse_s + 2.0 * kTs_s));
    EXPECT_NEAR(servo.y_m, 0.3, 1e-4);
  }
}

TEST(Trouble, ASensorThatDiesWhileSpeedsAreMeasuredEndsTheStage) {
  Servo servo;
  CommissioningLimits limits;
  limits.authority_V = 0.5;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_sign(procedure, servo), Failure::none);
  servo.dead_sensor = true;
  procedure.begin(Stage::speeds);
  run(procedure, servo);
  EXPECT_EQ(procedure.failure(), Failure::no_motion) << to_string(procedure.failure());
}

TEST(Trouble, ARunawayIsGivenUpWithNullAtOnce) {
  Servo servo;
  CommissioningLimits limits;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_sign(procedure, servo), Failure::none);
  servo.push_mps = 0.2;  // the spool hangs open
  procedure.begin(Stage::speeds);
  servo.from_m = servo.y_m;
  while (!procedure.over()) tick(procedure, servo);
  EXPECT_TRUE(procedure.failure() == Failure::travel || procedure.failure() == Failure::speed);
  EXPECT_LT(std::abs(servo.y_m - servo.from_m), limits.max_travel_m + 0.2 * kTs_s);
  EXPECT_EQ(procedure.step({.now_s = servo.t_s, .t_s = servo.t_s, .y_m = 0.3, .usable = true}),
            0.0);
}

TEST(Trouble, SpeedBeyondTheLimitIsGivenUp) {
  Servo servo = with(&Servo::gain_mps_per_V, 5.0);
  CommissioningLimits limits;
  limits.max_travel_m = 0.1;
  limits.max_speed_mps = 0.05;
  Commissioning procedure(limits);
  EXPECT_EQ(up_to_sign(procedure, servo), Failure::speed);
}

TEST(Trouble, APositionMissingForLongerThanTheGapIsGivenUp) {
  Servo servo;
  CommissioningLimits limits;
  Commissioning procedure(limits);
  servo.no_value = true;
  EXPECT_EQ(up_to_sign(procedure, servo), Failure::no_reading);
  EXPECT_EQ(servo.highest_V, 0.0);
}

TEST(Trouble, NoiseThatHidesTheMotionAndARodThatAnswersLateAreSaid) {
  Servo noisy = with(&Servo::noise_m, 3e-4);
  Commissioning procedure({});
  EXPECT_EQ(up_to_sign(procedure, noisy), Failure::too_noisy);
  Servo late = with(&Servo::delay_s, 0.06);
  EXPECT_EQ(up_to_speeds(procedure, late), Failure::too_slow);
  CommissioningLimits longer;
  longer.pulse_s = 0.6;
  Commissioning patient(longer);
  Servo same = with(&Servo::delay_s, 0.06);
  ASSERT_EQ(up_to_speeds(patient, same), Failure::none) << to_string(patient.failure());
  EXPECT_NEAR(patient.findings().latency_s, 0.07, kLatencyTolerance_s);
}

TEST(Home, IsTheStopAndTheRodIsTakenOffIt) {
  for (const int direction : {1, -1}) {
    Servo servo = with(&Servo::dead_zone_V, 0.2);
    servo.stop_low_m = 0.28;
    servo.stop_high_m = 0.32;
    CommissioningLimits limits;
    Commissioning procedure(limits);
    ASSERT_EQ(up_to_speeds(procedure, servo), Failure::none);
    procedure.begin_home(direction, false);
    run(procedure, servo);
    ASSERT_EQ(procedure.failure(), Failure::none) << to_string(procedure.failure());
    const double stop_m = direction > 0 ? 0.32 : 0.28;
    EXPECT_NEAR(procedure.findings().home_m, stop_m, 10e-6);  // noise and rounding
    EXPECT_GT(std::abs(servo.y_m - stop_m), 0.3 * limits.max_travel_m);
  }
}

TEST(Home, IsTheIndexWhereTheSensorHasOne) {
  Servo servo = with(&Servo::index_m, 0.32);
  CommissioningLimits limits;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_speeds(procedure, servo), Failure::none);
  procedure.begin_home(1, true);
  run(procedure, servo);
  EXPECT_EQ(procedure.failure(), Failure::none) << to_string(procedure.failure());
  EXPECT_NEAR(procedure.findings().home_m, 0.32, 0.01 * kTs_s + 10e-6);
  Servo walled = with(&Servo::index_m, 0.33);
  walled.stop_high_m = 0.32;
  procedure.begin(Stage::rest);
  ASSERT_EQ(up_to_speeds(procedure, walled), Failure::none);
  procedure.begin_home(1, true);
  run(procedure, walled);
  EXPECT_EQ(procedure.failure(), Failure::no_index);
}

TEST(Home, FartherThanPermittedIsGivenUp) {
  Servo servo;
  CommissioningLimits limits;
  limits.home_travel_m = 0.02;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_speeds(procedure, servo), Failure::none);
  procedure.begin_home(-1, false);
  run(procedure, servo);
  EXPECT_EQ(procedure.failure(), Failure::travel);
  EXPECT_LT(servo.farthest_m, 0.021);
}

}  // namespace
}  // namespace monitor::control
