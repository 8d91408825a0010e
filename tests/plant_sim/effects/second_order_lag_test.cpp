// Inertia of a servo's lag against the closed form of a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plant_sim/library.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kTau_s = 0.02;
constexpr double kU_V = 4.0;

Servo inert(double ratio) { return servo_with("second_order_lag", "inertia_ratio", ratio, kTau_s); }

// x = g u (1 - exp(-a t) (cos(w t) + a/w sin(w t))) with a = 1/(2 r tau), w^2 = 1/(r tau^2) - a^2
TEST(SecondOrderLag, AStepRisesAsTheClosedFormSays) {
  for (const double ratio : {0.3, 1.5625}) {
    Servo servo = inert(ratio);
    const double a = 1.0 / (2.0 * ratio * kTau_s);
    const double w = std::sqrt(1.0 / (ratio * kTau_s * kTau_s) - a * a);
    double t_s = 0.0;
    for (const double hold_s : {0.004, 0.01, 0.03, 0.1}) {
      hold(servo, kU_V, hold_s, 1e-3);
      t_s += hold_s;
      const double goal_mps = 0.05 * kU_V;
      const double wanted_mps =
          goal_mps * (1.0 - std::exp(-a * t_s) * (std::cos(w * t_s) + a / w * std::sin(w * t_s)));
      EXPECT_NEAR(servo.state.drive_mps, wanted_mps, 1e-12) << ratio << " " << t_s;
    }
  }
}

TEST(SecondOrderLag, LagsByTheTimeConstantWhateverItsInertia) {
  for (const double ratio : {0.0, 1e-4, 0.25, 2.0}) {
    Servo servo = inert(ratio);
    hold(servo, kU_V, 2.0, 1e-3);
    EXPECT_NEAR(servo.state.y_m, 0.05 * kU_V * (2.0 - kTau_s), 1e-9) << ratio;
  }
}

TEST(SecondOrderLag, WithoutInertiaIsTheLagOfFirstOrder) {
  Servo first = inert(0.0);
  Servo nearly = inert(1e-8);
  hold(first, kU_V, 0.03, 1e-3);
  hold(nearly, kU_V, 0.03, 1e-3);
  EXPECT_NEAR(nearly.state.y_m, first.state.y_m, 1e-9);
  EXPECT_NEAR(nearly.state.drive_mps, first.state.drive_mps, 1e-8);
}

TEST(SecondOrderLag, LeavesALagThatIsOfSecondOrderAlready) {
  Servo with = inert(1.0);
  Servo without = inert(0.0);
  for (Servo* servo : {&with, &without}) {
    servo->parameters.damping_ratio = 0.8;
    servo->prepare(1e-3);
    hold(*servo, kU_V, 0.03, 1e-3);
  }
  EXPECT_EQ(with.state.y_m, without.state.y_m);
}

TEST(SecondOrderLag, ActsOnServosAlone) {
  for (const PlantInfo& plant : plant_library()) {
    EXPECT_EQ(std::count(plant.sites.begin(), plant.sites.end(), "lag"),
              plant.name == std::string("velocity_servo") ? 1 : 0)
        << plant.name;
  }
}

}  // namespace
}  // namespace plant_sim::testing
