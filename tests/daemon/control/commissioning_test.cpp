// The procedure against a servo in closed form, truth being what the servo was made of:
//
//   y' = v,   v' = (gain dead_zone(sign u(t - delay) + valve.null_V - null) - v) / lag
#include "daemon/control/commissioning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <string>

#include "tests/count_allocations.h"

namespace monitor::control {
namespace {

constexpr double kTs_s = 0.005;
constexpr double kStep_s = 1e-4;

struct Servo {
  double gain_mps_per_V = 0.045;
  double null_V = 0.0;  ///< counted from the commanded one
  double dead_zone_V = 0.0;
  double delay_s = 0.008;
  double lag_s = 0.01;
  double noise_m = 2e-6;
  double count_m = 5e-6;  ///< of the encoder, 0: none
  double valve_sign = 1.0;
  double encoder_sign = 1.0;
  double stop_low_m = -1e9;
  double stop_high_m = 1e9;
  double push_mps = 0.0;    ///< whatever the command
  double down_ratio = 1.0;  ///< of the gain downward to that upward

  double y_m = 0.3;
  double v_mps = 0.0;
  bool dead_sensor = false;
  bool stuck = false;
  bool no_value = false;
  double index_m = 1e9;  ///< seen once y is above

  // ---
  double t_s = 0.0;
  double farthest_m = 0.0;  ///< true travel from `from_m`
  double from_m = 0.3;
  double highest_V = 0.0;
  std::deque<double> line{};
  std::mt19937 random{7};
  double last_reading_m = 0.3;

  void hold(double u_V, double duration_s) {
    highest_V = std::max(highest_V, std::abs(u_V));
    for (int n = static_cast<int>(std::lround(duration_s / kStep_s)); n > 0; --n) {
      line.push_back(u_V);
      double at_valve_V = 0.0;
      if (static_cast<double>(line.size()) > delay_s / kStep_s) {
        at_valve_V = line.front();
        line.pop_front();
      }
      const double x = valve_sign * at_valve_V - null_V;
      const double half = 0.5 * dead_zone_V;
      const double open = x > half ? x - half : x < -half ? x + half : 0.0;
      const double gain = gain_mps_per_V * (open < 0.0 ? down_ratio : 1.0);
      const double asked = stuck ? 0.0 : gain * open + push_mps;
      // Exact over the step: v decays to what is asked.
      const double decay = std::exp(-kStep_s / lag_s);
      y_m += asked * kStep_s + (v_mps - asked) * lag_s * (1.0 - decay);
      v_mps = asked + (v_mps - asked) * decay;
      y_m = std::clamp(y_m, stop_low_m, stop_high_m);
      farthest_m = std::max(farthest_m, std::abs(y_m - from_m));
    }
    t_s += duration_s;
  }
  double read() {
    if (dead_sensor) return last_reading_m;
    std::normal_distribution<double> noise(0.0, noise_m);
    const double y = encoder_sign * y_m + noise(random);
    return last_reading_m = count_m > 0.0 ? count_m * std::round(y / count_m) : y;
  }
};

/// Until the stage is over; then the rod coasts for half a second at null.
void run(Commissioning& procedure, Servo& servo) {
  servo.from_m = servo.y_m;
  servo.farthest_m = 0.0;
  while (!procedure.over()) {
    Commissioning::Input in;
    in.now_s = in.t_s = servo.t_s;
    in.usable = !servo.no_value;
    in.y_m = servo.read();
    in.homed = servo.y_m > servo.index_m;
    servo.hold(procedure.step(in), kTs_s);
  }
  servo.hold(0.0, 0.5);
}

Failure up_to_sign(Commissioning& procedure, Servo& servo) {
  for (const Stage stage : {Stage::rest, Stage::sign}) {
    procedure.begin(stage);
    run(procedure, servo);
    if (procedure.failure() != Failure::none) break;
  }
  return procedure.failure();
}

Failure up_to_speeds(Commissioning& procedure, Servo& servo) {
  if (up_to_sign(procedure, servo) != Failure::none) return procedure.failure();
  procedure.begin(Stage::speeds);
  run(procedure, servo);
  return procedure.failure();
}

/// Speeds: the slope of a line through some 24 readings over 0.12 s with 2.5 um of noise and
/// rounding is good to 15 um/s, 0.3 % of the slower speeds; the lag leaves exp(-0.08 / 0.01).
constexpr double kGainTolerance = 0.02;
/// Noise of 2 um over a speed of at least 4 mm/s, extrapolated over 0.1 s: 0.5 ms; the lag's tail.
constexpr double kLatencyTolerance_s = 0.0015;

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
      << words_of(procedure.failure()) << ", travel " << procedure.travel_m();
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

Servo with(double Servo::*what, double value) {
  Servo servo;
  servo.*what = value;
  return servo;
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
  // Of 60 readings: 1/sqrt(2 * 58) = 9 % standard error, three of them; rounding adds 0.3 %.
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

TEST(Trouble, AReversalAfterTheSignIsKnownIsStoppedWithinTheTravel) {
  for (const auto flipped : {&Servo::valve_sign, &Servo::encoder_sign}) {
    Servo servo;
    CommissioningLimits limits;
    Commissioning procedure(limits);
    ASSERT_EQ(up_to_sign(procedure, servo), Failure::none);
    servo.*flipped = -1.0;
    procedure.begin(Stage::speeds);
    run(procedure, servo);
    EXPECT_EQ(procedure.failure(), Failure::wrong_way) << words_of(procedure.failure());
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
  EXPECT_EQ(procedure.failure(), Failure::no_motion) << words_of(procedure.failure());
}

TEST(Trouble, ARunawayIsGivenUpWithNullAtOnce) {
  Servo servo;
  CommissioningLimits limits;
  Commissioning procedure(limits);
  ASSERT_EQ(up_to_sign(procedure, servo), Failure::none);
  servo.push_mps = 0.2;  // the spool hangs open
  procedure.begin(Stage::speeds);
  servo.from_m = servo.y_m;
  while (!procedure.over()) {
    Commissioning::Input in;
    in.now_s = in.t_s = servo.t_s;
    in.usable = true;
    in.y_m = servo.read();
    servo.hold(procedure.step(in), kTs_s);
  }
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
  ASSERT_EQ(up_to_speeds(patient, same), Failure::none) << words_of(patient.failure());
  EXPECT_NEAR(patient.findings().latency_s, 0.07, kLatencyTolerance_s);
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
      while (!procedure.over()) {
        Commissioning::Input in;
        in.now_s = in.t_s = servo.t_s;
        in.usable = true;
        in.y_m = servo.read();
        servo.hold(procedure.step(in), kTs_s);
      }
      farthest_m = std::max(farthest_m, servo.farthest_m);
      failure = procedure.failure();
      if (failure != Failure::none) break;
    }
    EXPECT_LT(farthest_m, limits.max_travel_m) << "servo " << n;
    if (servo.valve_sign < 0.0) {
      EXPECT_TRUE(failure == Failure::reversed || failure == Failure::travel)
          << "servo " << n << ": " << words_of(failure);
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
    ASSERT_EQ(procedure.failure(), Failure::none) << words_of(procedure.failure());
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
  EXPECT_EQ(procedure.failure(), Failure::none) << words_of(procedure.failure());
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
