// The effects between the command and the orifices, each against its own closed form.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

TEST(TransportDelay, ShiftsTheCommandByWholeSteps) {
  auto delayed = at_rest();
  auto shifted = at_rest();
  set_effect(*delayed, "transport_delay", "delay_s", 0.007);
  delayed->prepare(1e-3);
  const auto u_V = [](int k) { return k < 0 ? 0.0 : 1.0 + std::sin(k * 0.02); };
  for (int k = 0; k < 2000; ++k) {
    delayed->step(u_V(k));
    shifted->step(u_V(k - 7));
  }
  EXPECT_NEAR(delayed->state.y_m, shifted->state.y_m, 1e-15);
  EXPECT_GT(shifted->state.y_m, 0.33);
}

TEST(TransportDelay, BetweenStepsLosesExactlyTheDelayedTravel) {
  auto plant = at_rest<Servo>();
  for (const double delay_s : {0.0001, 0.0123, 0.5}) {
    set_effect(*plant, "transport_delay", "delay_s", delay_s);
    plant->prepare(1e-3);
    plant->reset();
    hold(*plant, 2.0, 1.0);
    EXPECT_NEAR(plant->state.y_m, 0.05 * 2.0 * (1.0 - delay_s), 1e-12) << delay_s;
  }
}

TEST(TransportDelay, ForgetsTheLastRunAtReset) {
  auto plant = at_rest<Servo>();
  set_effect(*plant, "transport_delay", "delay_s", 0.1);
  hold(*plant, 2.0, 1.0);
  plant->reset();
  hold(*plant, 0.0, 0.2);
  EXPECT_EQ(plant->state.y_m, 0.0);
}

TEST(NullBias, IsTheSameAsASteadyVoltage) {
  auto biased = at_rest();
  auto plain = at_rest();
  set_effect(*biased, "null_bias", "offset_V", -0.3);
  hold(*biased, 1.0, 0.5);
  hold(*plain, 0.7, 0.5);
  EXPECT_EQ(biased->state.y_m, plain->state.y_m);
}

TEST(ValveHysteresis, DrawsALoopOfTwiceItsHalfWidth) {
  auto plant = at_rest<Servo>();
  set_effect(*plant, "valve_hysteresis", "half_width_V", 0.08);
  plant->prepare(1e-3);
  const auto speed = [&](double u_V) {
    plant->step(u_V);
    return plant->speed_mps() / 0.05;
  };
  for (int k = 0; k <= 100; ++k) speed(0.01 * k);
  EXPECT_NEAR(speed(1.0), 0.92, 1e-12);
  EXPECT_NEAR(speed(0.95), 0.92, 1e-12);  // turned, but not yet by the whole loop
  EXPECT_NEAR(speed(0.5), 0.58, 1e-12);
  EXPECT_NEAR(speed(-1.0), -0.92, 1e-12);
  EXPECT_NEAR(speed(0.5), 0.42, 1e-12);
}

TEST(SpoolRateLimit, LetsTheSpoolRunAtTheRateAndNoFaster) {
  auto plant = at_rest();
  set_effect(*plant, "spool_rate_limit", "rate_mps", 1e-3);
  hold(*plant, 5.0, 0.04);
  const double early_m = plant->state.spool_m;
  hold(*plant, 5.0, 0.04);
  EXPECT_NEAR(plant->state.spool_m - early_m, 0.04 * 1e-3, 1e-12);
  EXPECT_NEAR(plant->state.spool_mps, 1e-3, 1e-12);
  hold(*plant, 5.0, 0.2);
  EXPECT_NEAR(plant->state.spool_m, 5.0 * 2.79e-5, 1e-9);
  hold(*plant, -5.0, 0.1);
  EXPECT_NEAR(plant->state.spool_mps, -1e-3, 1e-12);
}

TEST(Deadband, OpensNothingInsideAndShiftsTheCommandOutside) {
  auto plant = at_rest();
  set_effect(*plant, "deadband", "half_width_V", 0.2);
  hold(*plant, 0.19, 1.0);
  EXPECT_EQ(plant->state.y_m, 0.305);
  hold(*plant, -1.2, 4.0);
  EXPECT_NEAR(plant->state.v_mps, -steady_speed_mps(plant->parameters, 2.79e-5), 1e-9);
}

TEST(Deadband, LetsTheSpoolFollowLessWhereAShareLiesAheadOfIt) {
  auto plant = at_rest();
  set_effect(*plant, "deadband", "half_width_V", 0.2);
  set_effect(*plant, "deadband", "ahead_ratio", 0.75);
  hold(*plant, 0.14, 1.0);
  EXPECT_EQ(plant->state.spool_m, 0.0);
  hold(*plant, 0.19, 1.0);
  EXPECT_NEAR(plant->state.spool_m, 0.04 * 2.79e-5, 1e-12);
  EXPECT_EQ(plant->state.y_m, 0.305);
  hold(*plant, -1.2, 4.0);
  EXPECT_NEAR(plant->state.spool_m, -1.05 * 2.79e-5, 1e-12);
  EXPECT_NEAR(plant->state.v_mps, -steady_speed_mps(plant->parameters, 2.79e-5), 1e-9);
}

TEST(Deadband, OpensAlongAParabolaWithinARoundedCorner) {
  effects::Deadband<double>::Parameters p;
  const auto opening = [&](double command_V) {
    return effects::Deadband<double>::opening_m(p, 0.5 * command_V, 0.5) / 0.5;
  };
  p.half_width_V = 0.2;
  p.corner_V = 0.04;
  // (d + c)^2 / (4 c): nothing, a sixteenth, a quarter, nine sixteenths and the whole of c
  const std::vector<std::pair<double, double>> points{{0.0, 0.0},  {0.16, 0.0},    {0.18, 0.0025},
                                                      {0.2, 0.01}, {0.22, 0.0225}, {0.24, 0.04},
                                                      {1.0, 0.8}};
  for (const auto& [command_V, opening_V] : points) {
    EXPECT_NEAR(opening(command_V), opening_V, 1e-15) << command_V;
    EXPECT_NEAR(opening(-command_V), -opening_V, 1e-15) << command_V;
  }
  // wider than the band: the share (c - w) / c of the edges is open at null
  p.corner_V = 0.3;
  EXPECT_NEAR(opening(0.05), 0.05 / 3.0, 1e-15);
  EXPECT_NEAR(opening(-0.05), -0.05 / 3.0, 1e-15);
  EXPECT_NEAR(opening(0.2), 0.3 * 0.3 / 1.2, 1e-15);
  EXPECT_NEAR(opening(0.5), 0.3, 1e-15);
}

// Edges of the gap sqrt(e^2 + r^2), of which one opens as the other shuts; at e = 0, E = r / 2.
TEST(Deadband, OpensByTheGapsThatAClearanceLeaves) {
  effects::Deadband<double>::Parameters p;
  p.half_width_V = 0.3;
  p.clearance_V = 0.4;
  const auto opening = [&](double command_V) {
    return effects::Deadband<double>::opening_m(p, 0.5 * command_V, 0.5) / 0.5;
  };
  // triangles of 3, 4, 5: at 0.6 the edges are 0.3 open and 0.9 shut, at 0 both 0.3 shut
  EXPECT_EQ(opening(0.0), 0.0);
  EXPECT_NEAR(opening(0.6), 0.5 * (0.3 + 0.5) - 0.5 * (std::hypot(0.9, 0.4) - 0.9), 1e-15);
  EXPECT_NEAR(opening(-0.6), -opening(0.6), 1e-15);
  EXPECT_NEAR(opening(0.3), 0.2 - 0.5 * (std::hypot(0.6, 0.4) - 0.6), 1e-15);
  // far away a sharp edge, less what the other one still lets back
  EXPECT_NEAR(opening(1e4), 1e4 - 0.3, 1e-4);
  p.clearance_V = 1e-9;
  EXPECT_NEAR(opening(0.1), 0.0, 1e-15);
  EXPECT_NEAR(opening(0.7), 0.4, 1e-15);
}

TEST(FlowAsymmetry, OpensMoreWhenExtendingAndLessWhenRetracting) {
  for (const double u_V : {1.0, -1.0}) {
    auto plant = at_rest();
    set_effect(*plant, "flow_asymmetry", "asymmetry_ratio", 0.2);
    const double expected = steady_speed_mps(plant->parameters, (1.0 + 0.2 * u_V) * 2.79e-5);
    hold(*plant, u_V, kSettling_m / expected);
    EXPECT_NEAR(plant->state.v_mps, u_V * expected, 1e-8 * expected);
  }
}

TEST(FlowSaturation, BoundsTheSpeedByTheFlow) {
  for (const double u_V : {5.0, -5.0}) {
    auto plant = at_rest();
    set_effect(*plant, "flow_saturation", "limit_m3ps", 4e-5);
    hold(*plant, u_V, 2.0);
    EXPECT_NEAR(std::abs(plant->state.v_mps), 4e-5 / 6.33e-4, 1e-9);
  }
}

TEST(SupplyDroop, SlowsTheRodAsTheQuadraticSays) {
  // D Q with Q = A v acts in Ps - Pe = 2 (A v/(G x))^2 + load/A like a damping of D A^2
  for (const double u_V : {2.0, -2.0}) {
    auto plant = at_rest();
    set_effect(*plant, "supply_droop", "droop_Pa_per_m3ps", 3e10);
    const double d = 3e10 * 6.33e-4 * 6.33e-4;
    const double expected = steady_speed_mps(plant->parameters, 2.0 * 2.79e-5, d);
    EXPECT_LT(expected, 0.9 * steady_speed_mps(plant->parameters, 2.0 * 2.79e-5));
    hold(*plant, u_V, kSettling_m / expected);
    EXPECT_NEAR(std::abs(plant->state.v_mps), expected, 1e-6 * expected);
  }
}

TEST(SupplyDroop, SatisfiesBothOfItsEquations) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 10000; ++i) {
    const effects::SupplyDroop<double>::Parameters p{1e12 * std::pow(unit(random), 4)};
    const double port_Pa = 1.4e7 * unit(random);
    const double g = 1e-7 * unit(random);
    const double ahead_Pa = effects::SupplyDroop<double>::supply_Pa(p, 7e6, port_Pa, g);
    const double drop_Pa = ahead_Pa - port_Pa;
    const double q_m3ps = g * std::copysign(std::sqrt(std::abs(drop_Pa)), drop_Pa);
    EXPECT_NEAR(7e6 - p.droop_Pa_per_m3ps * q_m3ps, ahead_Pa, 1e-2);
    EXPECT_LE(std::abs(drop_Pa), std::abs(7e6 - port_Pa));
  }
}

}  // namespace
}  // namespace plant_sim::testing
