#include "daemon/control/reference_generator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace monitor::control {
namespace {

constexpr double kTs_s = 0.005;
constexpr double kRounding_m = 1e-12;

double quintic(double x) { return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x); }

TEST(ReferenceGenerator, AtOnceIsTheSignalItself) {
  const Sine sine(0.3, 0.02, 0.5);
  ReferenceGenerator reference(sine, {1.0, 0.05, kTs_s});
  reference.start(0.1, 40, true);
  for (int k = 0; k < 300; ++k) EXPECT_EQ(reference.at(40 + k), sine.at(k * kTs_s));
}

TEST(ReferenceGenerator, BeginsWhereTheRodIsAndBlendsIntoTheSignal) {
  const Sine sine(0.3, 0.02, 0.5);
  ReferenceGenerator reference(sine, {2.0, 10.0, kTs_s});  // no limit of speed to speak of
  reference.start(0.28, 7, false);
  EXPECT_DOUBLE_EQ(reference.at(7), 0.28);
  for (int k = 1; k < 800; ++k) {
    const double signal_m = sine.at(k * kTs_s);
    const double w = k < 400 ? quintic(k / 400.0) : 1.0;
    EXPECT_NEAR(reference.at(7 + k), 0.28 + w * (signal_m - 0.28), kRounding_m) << k;
  }
}

TEST(ReferenceGenerator, IsNeverFasterThanAllowedUntilItHasMetTheSignal) {
  const Sine still(0.5, 0.0, 0.0);
  ReferenceGenerator reference(still, {0.1, 0.02, kTs_s});
  reference.start(0.3, 0, false);
  double last_m = reference.at(0);
  int met = 0;
  for (int k = 1; k < 4000; ++k) {
    const double r_m = reference.at(k);
    ASSERT_LE(std::abs(r_m - last_m), 0.02 * kTs_s + kRounding_m);
    if (met == 0 && r_m == 0.5) met = k;
    last_m = r_m;
  }
  EXPECT_NEAR(met * kTs_s, 0.2 / 0.02, 0.1) << "at the limit all the way but the first 0.1 s";
}

TEST(ReferenceGenerator, HoldsAndResumesFromWhereTheRodIsThen) {
  const Sine sine(0.3, 0.02, 0.5);
  ReferenceGenerator reference(sine, {1.0, 0.05, kTs_s});
  reference.start(0.3, 0, false);
  for (int k = 0; k < 100; ++k) reference.at(k);
  reference.hold(0.311);
  EXPECT_TRUE(reference.holding());
  for (int k = 100; k < 200; ++k) EXPECT_EQ(reference.at(k), 0.311);
  reference.start(0.3109, 200, false);
  EXPECT_FALSE(reference.holding());
  EXPECT_DOUBLE_EQ(reference.at(200), 0.3109);
}

TEST(ReferenceGenerator, RejoinsASignalThatHasGoneOn) {
  const Sine sine(0.3, 0.02, 0.5);
  ReferenceGenerator reference(sine, {1.0, 10.0, kTs_s});
  reference.start(0.3, 0, true);
  for (int k = 0; k < 100; ++k) reference.at(k);
  reference.resume_from(0.25, 160);
  EXPECT_DOUBLE_EQ(reference.at(160), 0.25);
  EXPECT_NEAR(reference.at(260), 0.25 + quintic(0.5) * (sine.at(260 * kTs_s) - 0.25), kRounding_m);
  EXPECT_NEAR(reference.at(400), sine.at(400 * kTs_s), kRounding_m);
}

TEST(ReferenceGenerator, MovesOverToAnotherSignalWithoutAJump) {
  const Sine sine(0.3, 0.02, 0.5);
  ReferenceGenerator reference(sine, {1.0, 0.05, kTs_s});
  reference.start(0.3, 0, true);
  double last_m = 0.0;
  for (int k = 0; k < 100; ++k) last_m = reference.at(k);
  reference.follow(Sine(0.2, 0.0, 0.0), 100, true);
  EXPECT_NEAR(reference.at(100), sine.at(100 * kTs_s), kRounding_m);
  EXPECT_NEAR(reference.at(100), last_m, 0.08 * kTs_s);
  for (int k = 101; k < 2000; ++k) reference.at(k);
  EXPECT_DOUBLE_EQ(reference.at(2000), 0.2);
}

TEST(Ramp, IsAStraightLineToNull) {
  Ramp ramp(0.2);
  EXPECT_FALSE(ramp.active());
  ramp.start(-3.0, 10.0);
  EXPECT_DOUBLE_EQ(ramp.at(10.0), -3.0);
  EXPECT_NEAR(ramp.at(10.05), -2.25, 1e-9);
  EXPECT_FALSE(ramp.over(10.195));
  EXPECT_TRUE(ramp.over(10.2));
  EXPECT_EQ(ramp.at(10.2), 0.0);
  Ramp none(0.0);
  none.start(2.0, 1.0);
  EXPECT_EQ(none.at(1.0), 0.0);
}

}  // namespace
}  // namespace monitor::control
