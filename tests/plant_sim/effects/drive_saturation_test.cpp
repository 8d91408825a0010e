// A drive that follows no command beyond a limit: an axis against the closed form of a mass that it
// pushes, other plants against the command that is left.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kLimit_V = 1.5;

/// An axis without damping or memory, at rest, after `duration_s` of a constant command.
std::unique_ptr<Axis> pushed_limited(double u_V, double limit_V, double lag_s, double duration_s) {
  auto axis = std::make_unique<Axis>();
  axis->parameters.damping_N_s_per_m = 0.0;
  set_effect(*axis, "drive_saturation", "limit_V", limit_V);
  if (lag_s > 0.0) set_effect(*axis, "drive_lag", "lag_s", lag_s);
  axis->prepare(1e-3);
  axis->reset();
  if (lag_s > 0.0) axis->step(0.0);
  hold(*axis, u_V, duration_s, 1e-3);
  return axis;
}

// M v = g min(|u|, limit) t
TEST(DriveSaturation, ForceIsThatOfTheLimitAndNoMore) {
  for (const double u_V : {1.0, 1.5, 4.0}) {
    for (const double sign : {1.0, -1.0}) {
      const auto axis = pushed_limited(sign * u_V, kLimit_V, 0.0, 0.5);
      const double wanted_mps = sign * axis->parameters.gain_N_per_V * std::min(u_V, kLimit_V) *
                                0.5 / axis->parameters.mass_kg;
      EXPECT_NEAR(axis->state.v_mps, wanted_mps, 1e-12) << sign * u_V;
    }
  }
}

TEST(DriveSaturation, LimitsBeforeTheLag) {
  // a lag of a limited command, not a limit of a lagging one
  const auto limited = pushed_limited(10.0, kLimit_V, 0.05, 0.1);
  const auto asked = pushed_limited(kLimit_V, 100.0, 0.05, 0.1);
  EXPECT_NEAR(limited->state.v_mps, asked->state.v_mps, 1e-12);
}

template <class Plant>
class LimitedDrive : public ::testing::Test {};
using LaggingPlants = ::testing::Types<Servo, Actuator, HydraulicCylinder<double>>;
TYPED_TEST_SUITE(LimitedDrive, LaggingPlants);

TYPED_TEST(LimitedDrive, ActsAheadOfTheLagOfEveryOtherPlant) {
  auto limited = at_rest<TypeParam>();
  auto asked = at_rest<TypeParam>();
  set_effect(*limited, "drive_saturation", "limit_V", kLimit_V);
  for (const double u_V : {10.0, -10.0, 0.5}) {
    hold(*limited, u_V, 0.05);
    hold(*asked, std::clamp(u_V, -kLimit_V, kLimit_V), 0.05);
    EXPECT_EQ(limited->state.y_m, asked->state.y_m) << u_V;
  }
}

}  // namespace
}  // namespace plant_sim::testing
