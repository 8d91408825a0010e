// The actuator against closed forms, and its behaviour at the limits that the source leaves open.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

TEST(HydraulicActuator, ReachesTheSteadySpeedOfTheClosedForm) {
  for (const double u_V : {0.5, 2.0, -1.0}) {
    auto plant = at_rest();
    const double expected =
        steady_speed_mps(plant->parameters, 2.79e-5 * std::abs(u_V)) * (u_V > 0 ? 1.0 : -1.0);
    hold(*plant, u_V, kSettling_m / std::abs(expected));
    EXPECT_NEAR(plant->state.v_mps, expected, 1e-8 * std::abs(expected)) << u_V;
  }
}

TEST(HydraulicActuator, ConvergesWithTheFourthPowerOfTheStep) {
  const auto position = [](double step_s) {
    auto plant = at_rest();
    hold(*plant, 1.0, 0.2, step_s);
    return plant->state.y_m;
  };
  const double exact = position(1e-3 / 32.0);
  const double coarse = std::abs(position(0.25e-3) - exact);
  const double fine = std::abs(position(0.125e-3) - exact);
  EXPECT_NEAR(coarse / fine, 16.0, 1.0);
}

TEST(HydraulicActuator, StaysAtRestWithTheValveShut) {
  auto plant = at_rest();
  hold(*plant, 0.0, 1.0);
  EXPECT_EQ(plant->state.y_m, 0.305);
  EXPECT_EQ(plant->state.in_Pa, 0.5 * 6.89e6);
}

TEST(HydraulicActuator, ComesToRestAtEachEndStopWithFullPressureBehindIt) {
  auto plant = at_rest();
  hold(*plant, 10.0, 3.0);
  EXPECT_EQ(plant->state.y_m, 0.61);
  EXPECT_EQ(plant->state.v_mps, 0.0);
  EXPECT_NEAR(plant->state.in_Pa, 6.89e6, 1.0);
  EXPECT_NEAR(plant->state.out_Pa, 0.0, 1.0);
  hold(*plant, -10.0, 3.0);
  EXPECT_EQ(plant->state.y_m, 0.0);
  EXPECT_EQ(plant->state.v_mps, 0.0);
  EXPECT_NEAR(plant->state.out_Pa, 6.89e6, 1.0);
  hold(*plant, 1.0, 4.0);
  EXPECT_NEAR(plant->state.v_mps, steady_speed_mps(plant->parameters, 2.79e-5), 1e-6);
}

TEST(HydraulicActuator, FlowsBackThroughAnOrificeUnderAnOverrunningPressure) {
  auto plant = at_rest();
  plant->state.in_Pa = 9e6;  // above the supply
  plant->state.out_Pa = 9e6;
  hold(*plant, 0.5, 0.02);
  EXPECT_LT(plant->state.in_Pa, 9e6);
  hold(*plant, 0.5, 8.0);
  EXPECT_NEAR(plant->state.v_mps, steady_speed_mps(plant->parameters, 0.5 * 2.79e-5), 1e-6);
}

TEST(HydraulicActuator, KeepsPressuresAboveVapourWhenAHeavyLoadPullsAChamberEmpty) {
  auto plant = at_rest();
  plant->parameters.mass_kg = 2000.0;
  hold(*plant, 10.0, 0.3);
  EXPECT_GT(plant->state.v_mps, 0.3);
  double least_Pa = 1e9;
  for (int i = 0; i < 200; ++i) {
    hold(*plant, 0.0, 1e-3);
    least_Pa = std::min({least_Pa, plant->state.in_Pa, plant->state.out_Pa});
  }
  EXPECT_EQ(least_Pa, 0.0);
}

/// The printed regime, by the thesis's equations alone, step by step.
TEST(HydraulicActuator, IsTheSourcesEquationsToTheLastBitsInsideThePrintedRegime) {
  auto with_limits = at_rest();
  Actuator::State plain = with_limits->state;
  for (int k = 0; k < 2000; ++k) {
    const double u_V = 100.0 * (0.0254 * std::sin(M_PI * k * 1e-3) + 0.305 - plain.y_m);
    const auto rate = [&](const Actuator::State& x) {
      const double g = 0.60 * 2.07e-2 * std::sqrt(2.0 / 847.0) * x.spool_m;
      const bool extends = x.spool_m >= 0.0;
      const double in = g * std::sqrt(extends ? 6.89e6 - x.in_Pa : x.in_Pa);
      const double out = g * std::sqrt(extends ? x.out_Pa : 6.89e6 - x.out_Pa);
      const double swept = 6.33e-4 * x.v_mps;
      return Actuator::State{x.v_mps,
                             (6.33e-4 * (x.in_Pa - x.out_Pa) - 1000.0 * x.v_mps) * (1.0 / 50.0),
                             6.89e8 / (1e-5 + 6.33e-4 * x.y_m) * (in - swept),
                             6.89e8 / (1e-5 + 6.33e-4 * (0.61 - x.y_m)) * (swept - out),
                             x.spool_mps,
                             2.79e-5 * (628.0 * 628.0) * u_V - 2.0 * 0.70 * 628.0 * x.spool_mps -
                                 628.0 * 628.0 * x.spool_m};
    };
    plain = runge_kutta_step(plain, 1e-3, rate);
    with_limits->step(u_V);
    ASSERT_EQ(plain.y_m, with_limits->state.y_m) << k;
    ASSERT_EQ(plain.in_Pa, with_limits->state.in_Pa) << k;
  }
}

}  // namespace
}  // namespace plant_sim::testing
