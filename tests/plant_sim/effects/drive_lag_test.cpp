// A lag of the drive against the closed form of a mass that it pushes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "plant_sim/library.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kU_V = 2.0;
constexpr double kLag_s = 0.02;

/// An axis without damping under a command that steps from 0 to kU_V.
std::unique_ptr<Axis> pushed(double lag_s, double step_s, double duration_s) {
  auto axis = std::make_unique<Axis>();
  axis->parameters.damping_N_s_per_m = 0.0;
  set_effect(*axis, "drive_lag", "lag_s", lag_s);
  axis->prepare(step_s);
  axis->reset();
  axis->step(0.0);
  hold(*axis, kU_V, duration_s, step_s);
  return axis;
}

// M v = g u (t - lag (1 - exp(-t/lag))), whatever the step
TEST(DriveLag, SpeedIsThatOfTheLaggingForce) {
  for (const double step_s : {1e-3, 5e-3}) {
    for (const double t_s : {0.01, 0.05, 0.5}) {
      const auto axis = pushed(kLag_s, step_s, t_s);
      const double rise_s = t_s - kLag_s * (1.0 - std::exp(-t_s / kLag_s));
      const double wanted_mps =
          axis->parameters.gain_N_per_V * kU_V * rise_s / axis->parameters.mass_kg;
      EXPECT_NEAR(axis->state.v_mps, wanted_mps, 1e-12) << step_s << " " << t_s;
    }
  }
}

TEST(DriveLag, LongAfterAStepIsADeadTimeOfItsLength) {
  const auto lagging = pushed(kLag_s, 1e-3, 1.0);
  const auto prompt = pushed(0.0, 1e-3, 1.0 - kLag_s);
  EXPECT_NEAR(lagging->state.v_mps, prompt->state.v_mps, 1e-12);
}

TEST(DriveLag, ForgetsTheLastRunAtReset) {
  const auto axis = pushed(kLag_s, 1e-3, 0.5);
  axis->reset();
  axis->step(0.0);
  EXPECT_EQ(axis->state.v_mps, 0.0);
}

TEST(DriveLag, IsForAxesAlone) {
  int found = 0;
  for (const EffectInfo& effect : effect_library()) {
    if (effect.name != "drive_lag") continue;
    ++found;
    for (const char* plant : {"velocity_servo", "hydraulic_actuator", "hydraulic_cylinder"}) {
      const auto& sites = find_plant(plant)->sites;
      EXPECT_EQ(std::count(sites.begin(), sites.end(), effect.sites.front()), 0) << plant;
    }
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace plant_sim::testing
