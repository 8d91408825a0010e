// A servo that ramps the speed that it is asked for, against the closed form of the ramp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plant_sim/library.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kLimit_mps2 = 0.4;

Servo ramped(double tau_s) {
  return servo_with("acceleration_limit", "limit_mps2", kLimit_mps2, tau_s);
}

// y = a t^2/2 up to gain u, then gain u t
TEST(AccelerationLimit, ASpeedIsReachedByARamp) {
  for (const double u_V : {4.0, -4.0, 0.01}) {
    Servo servo = ramped(0.0);
    const double goal_mps = 0.05 * u_V;
    const double ramp_s = std::abs(goal_mps) / kLimit_mps2;
    for (const double t_s : {0.2, 0.3, 0.9}) {
      Servo run = servo;
      hold(run, u_V, t_s, 1e-3);
      const double in_s = std::min(t_s, ramp_s);
      const double way_m =
          std::copysign(0.5 * kLimit_mps2 * in_s * in_s, goal_mps) + goal_mps * (t_s - in_s);
      EXPECT_NEAR(run.state.y_m, way_m, 1e-12) << u_V << " V, " << t_s << " s";
    }
  }
}

TEST(AccelerationLimit, TheRampLiesAheadOfTheLag) {
  // long after the start of a ramp, a lag is late by its time constant
  Servo servo = ramped(0.02);
  hold(servo, 8.0, 0.5, 1e-3);
  EXPECT_NEAR(servo.state.drive_mps, kLimit_mps2 * (0.5 - 0.02), 0.5e-3 * kLimit_mps2 + 1e-9);
}

TEST(AccelerationLimit, ActsOnServosAlone) {
  for (const PlantInfo& plant : plant_library()) {
    const auto& sites = plant.sites;
    EXPECT_EQ(std::count(sites.begin(), sites.end(), "set_speed"),
              plant.name == std::string("velocity_servo") ? 1 : 0)
        << plant.name;
  }
}

}  // namespace
}  // namespace plant_sim::testing
