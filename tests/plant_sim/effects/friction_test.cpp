// Dry friction against closed forms and against its own differential equation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

using F = effects::Friction<double>;

TEST(Friction, HoldsTheRodUntilThePressureForceExceedsIt) {
  auto plant = at_rest();
  set_effect(*plant, "friction", "coulomb_N", 200.0);
  plant->prepare(1e-3);
  plant->state.in_Pa += 150.0 / 6.33e-4;
  hold(*plant, 0.0, 1.0);
  EXPECT_NEAR(plant->state.y_m, 0.305, 1e-8);
  plant->state.in_Pa = 0.5 * 6.89e6 + 400.0 / 6.33e-4;
  plant->state.out_Pa = 0.5 * 6.89e6;
  hold(*plant, 0.0, 0.5);
  EXPECT_GT(plant->state.y_m, 0.305 + 1e-6);
}

TEST(Friction, SlidesAtTheSpeedOfTheClosedFormInEachDirection) {
  for (const double u_V : {1.0, -1.0, 0.01, -0.01}) {
    auto plant = at_rest();
    set_effect(*plant, "friction", "coulomb_N", 600.0);
    set_effect(*plant, "friction", "direction_ratio", 0.25);
    const double force_N = u_V > 0 ? 750.0 : 450.0;
    const double expected =
        steady_speed_mps(plant->parameters, 2.79e-5 * std::abs(u_V), 0.0, 0.0, force_N);
    hold(*plant, u_V, kSettling_m / expected);
    EXPECT_NEAR(std::abs(plant->state.v_mps), expected, 1e-6 * expected) << u_V;
  }
}

TEST(Friction, StopsAFreeRodInTheTimeAndWayOfTheClosedForm) {
  // no oil force: equal pressures, no area to speak of
  auto plant = std::make_unique<Actuator>();
  plant->parameters.area_m2 = 1e-6;
  plant->parameters.damping_N_s_per_m = 0.0;
  set_effect(*plant, "friction", "coulomb_N", 100.0);
  plant->prepare(1e-3);
  plant->reset();
  plant->parameters.bulk_modulus_Pa = 1e6;
  plant->state.v_mps = 0.2;
  const double stop_s = 0.2 / (100.0 / 50.0);
  hold(*plant, 0.0, stop_s + 0.05);
  EXPECT_LT(std::abs(plant->state.v_mps), 1e-8);
  // v^2 / (2 a) = 0.01 m; the last step is a relaxation, a step_s^2 / 2 = 1e-6 m longer
  EXPECT_NEAR(plant->state.y_m, 0.305 + 0.01, 2e-6);
}

TEST(Friction, BrakesAFreeMassAlongTheClosedFormOfItsTransition) {
  // m v' = -F tanh(v / vt): sinh(v / vt) = sinh(v0 / vt) e^(-F t / (m vt))
  for (const double transition_mps : {2e-2, 1e-3, 2e-4}) {
    auto axis = at_rest<Axis>();
    axis->parameters.damping_N_s_per_m = 0.0;
    axis->parameters.mass_kg = 50.0;
    set_effect(*axis, "friction", "coulomb_N", 100.0);
    set_effect(*axis, "friction", "transition_mps", transition_mps);
    axis->prepare(1e-3);
    axis->reset();
    const double from_mps = 20.0 * transition_mps;
    axis->state.v_mps = from_mps;
    const double per_s = 100.0 / (50.0 * transition_mps);
    const double time_s = 1e-3 * std::ceil(22.0 / per_s / 1e-3);
    hold(*axis, 0.0, time_s);
    const double ratio = std::sinh(20.0) * std::exp(-per_s * time_s);
    EXPECT_NEAR(axis->state.v_mps / transition_mps, std::asinh(ratio), 0.02) << transition_mps;
  }
}

template <class Plant>
std::vector<double> stick_slip_m(double transition_mps) {
  auto plant = at_rest<Plant>();
  set_effect(*plant, "friction", "coulomb_N", 30.0);
  set_effect(*plant, "friction", "transition_mps", transition_mps);
  plant->prepare(1e-3);
  plant->reset();
  std::vector<double> y_m;
  for (int i = 0; i < 400; ++i) {
    plant->step(std::sin(0.05 * i));
    y_m.push_back(plant->state.y_m);
  }
  return y_m;
}

TEST(Friction, IsRigidWhereNoPartOfAStepResolvesItsTransition) {
  // in 1/64 ms 30 N change the speed of 50 kg (100 kg) by 9.4e-6 (4.7e-6) m/s; half is resolved
  EXPECT_EQ(stick_slip_m<Actuator>(1e-6), stick_slip_m<Actuator>(0.0));
  EXPECT_EQ(stick_slip_m<Axis>(1e-6), stick_slip_m<Axis>(0.0));
  EXPECT_NE(stick_slip_m<Actuator>(1e-5), stick_slip_m<Actuator>(0.0));
  EXPECT_NE(stick_slip_m<Axis>(1e-5), stick_slip_m<Axis>(0.0));
}

TEST(Friction, StopsACoastingMassInTheWayOfTheClosedFormInEitherDirection) {
  for (const double direction : {1.0, -1.0}) {
    auto axis = at_rest<Axis>();
    axis->parameters.damping_N_s_per_m = 0.0;
    axis->parameters.mass_kg = 50.0;
    set_effect(*axis, "friction", "coulomb_N", 100.0);
    set_effect(*axis, "friction", "direction_ratio", 0.5);
    axis->prepare(1e-3);
    axis->reset();
    const double from_m = axis->state.y_m;
    axis->state.v_mps = direction * 0.2003;
    hold(*axis, 0.0, 0.5);
    const double deceleration = (direction > 0.0 ? 150.0 : 50.0) / 50.0;
    // the part in which it stops is a relaxation: deceleration (step / 16)^2 / 2
    EXPECT_NEAR(std::abs(axis->state.y_m - from_m), 0.2003 * 0.2003 / (2.0 * deceleration), 1e-8);
  }
}

TEST(Friction, GradualContactNeverDrivesAndIsTheSlidingLevelBeyondItsTransition) {
  F::Parameters p;
  p.coulomb_N = 100.0;
  p.direction_ratio = 0.2;
  p.transition_mps = 1e-3;
  for (const double v_mps : {-0.1, -1e-3, -1e-5, 0.0, 1e-5, 1e-3, 0.1}) {
    const effects::DryContact<double> at{v_mps, 0.0, 0.0, 5e5};
    const double level_N = v_mps < 0.0 ? 80.0 : 120.0;
    EXPECT_NEAR(F::friction_N(p, {}, at), level_N * std::tanh(v_mps / 1e-3), 1e-9) << v_mps;
  }
  // a step that does not resolve it: the rigid contact holds what drives
  const effects::DryContact<double> coarse{0.0, 0.0, 50.0, 5e4};
  EXPECT_DOUBLE_EQ(F::friction_N(p, {}, coarse), 50.0);
}

TEST(Friction, FallsFromStaticToCoulombAlongStribecksCurve) {
  F::Parameters p;
  p.coulomb_N = 100.0;
  p.static_N = 180.0;
  p.stribeck_mps = 0.02;
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 0.0), 180.0);
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 0.02), 100.0 + 80.0 * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, -0.02), 100.0 + 80.0 * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 1.0), 100.0);
  p.static_N = 50.0;  // below sliding friction: no influence
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 0.0), 100.0);
  p.stribeck_mps = 0.0;
  p.static_N = 180.0;
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 1e-6), 100.0);
}

TEST(Friction, IsThatOfNewParametersAtOnce) {
  F::Parameters p;
  p.coulomb_N = 200.0;
  p.static_N = 300.0;
  p.stribeck_mps = 0.01;
  F::Memory memory;
  F::accept(p, memory, 1e-6, 0.005);
  const effects::DryContact<double> at{0.005, 0.0, 1e4, 0.0};
  EXPECT_NEAR(F::friction_N(p, memory, at), 200.0 + 100.0 * std::exp(-0.25), 1e-9);
  p.stribeck_mps = 0.004;
  memory.prepare(1e-3);
  EXPECT_NEAR(F::friction_N(p, memory, at), 200.0 + 100.0 * std::exp(-1.5625), 1e-9);
}

TEST(Friction, NeverDrivesTheRod) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    F::Parameters p;
    p.coulomb_N = 500.0 * std::abs(unit(random));
    p.static_N = 1000.0 * std::abs(unit(random));
    p.stribeck_mps = 0.1 * std::abs(unit(random));
    p.direction_ratio = unit(random);
    effects::DryContact<double> at{0.1 * std::pow(unit(random), 3), 0.0, 3000.0 * unit(random),
                                   5e4};
    EXPECT_GE(F::friction_N(p, {}, at) * at.v_mps, 0.0);
  }
}

TEST(Friction, ScalesStribecksCurveByTheDirection) {
  F::Parameters p;
  p.coulomb_N = 100.0;
  p.static_N = 160.0;
  p.stribeck_mps = 0.01;
  p.direction_ratio = 0.25;
  EXPECT_DOUBLE_EQ(F::level_N(p, 1.0, 0.0), 200.0);
  EXPECT_DOUBLE_EQ(F::level_N(p, -1.0, 0.0), 120.0);
  EXPECT_NEAR(F::level_N(p, 1.0, 0.01), 1.25 * (100.0 + 60.0 * std::exp(-1.0)), 1e-9);
  EXPECT_NEAR(F::level_N(p, -1.0, -0.01), 0.75 * (100.0 + 60.0 * std::exp(-1.0)), 1e-9);
  // what holds the rod at rest, either way
  const effects::DryContact<double> pushed{0.0, 0.0, 190.0, 5e4};
  EXPECT_DOUBLE_EQ(F::friction_N(p, {}, pushed), 190.0);
  const effects::DryContact<double> pulled{0.0, 0.0, -190.0, 5e4};
  EXPECT_DOUBLE_EQ(F::friction_N(p, {}, pulled), -120.0);
}

F::Parameters bristle_with_rise() {
  F::Parameters p;
  p.coulomb_N = 200.0;
  p.static_N = 300.0;
  p.stribeck_mps = 0.01;
  p.presliding_stiffness_N_per_m = 1e7;
  return p;
}

TEST(Friction, BristleFollowsItsDifferentialEquation) {
  F::Parameters p;
  p.coulomb_N = 200.0;
  p.presliding_stiffness_N_per_m = 1e7;
  p.direction_ratio = 0.2;
  F::Memory exact;
  double z = 0.0;
  const auto travel = [&](double dx, int parts) {
    F::accept(p, exact, dx, 0.01);
    const double direction = dx > 0 ? 1.0 : -1.0;
    const double level = 200.0 * (1.0 + direction * 0.2);
    for (int i = 0; i < parts; ++i) {
      const double d = dx / parts;
      z += d - std::abs(d) * 1e7 * z / level;
    }
  };
  for (const double dx : {5e-6, 30e-6, -10e-6, -80e-6, 7e-6}) {
    travel(dx, 200000);
    // Euler's error over a bristle length of 20 um in steps of at most 4e-10 m
    EXPECT_NEAR(exact.deflection_m, z, 2e-9) << dx;
  }
}

TEST(Friction, BristleYieldsAtTheLevelsOfTheSpeedsOnItsWay) {
  const F::Parameters p = bristle_with_rise();
  F::Memory memory;
  double z = 0.0;
  double v_mps = 0.0;
  constexpr double kStep_s = 1e-3;
  constexpr int kParts = 20000;
  for (const double next_mps : {0.004, 0.009, 0.013, 0.011, 0.006}) {
    double dx = 0.0;
    for (int i = 0; i < kParts; ++i) {  // the differential equation, the speed changing evenly
      const double v = v_mps + (next_mps - v_mps) * (i + 0.5) / kParts;
      const double level = 200.0 + 100.0 * std::exp(-(v / 0.01) * (v / 0.01));
      z += v * kStep_s / kParts * (1.0 - 1e7 * z / level);
      dx += v * kStep_s / kParts;
    }
    F::accept(p, memory, dx, next_mps);
    v_mps = next_mps;
    // levels differ by up to 50 N within a step: judged by the last one alone it is off by 0.5 um
    EXPECT_NEAR(memory.deflection_m, z, 0.1e-6) << next_mps;
  }
}

TEST(Friction, PresslidingStoresNoMoreThanItTakes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const F::Parameters p = bristle_with_rise();
  F::Memory memory;
  double given_J = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double v_mps = 0.05 * unit(random);
    const double dx = 1e-7 * unit(random);  // small against the bristle: force nearly constant
    const double before_N = 1e7 * memory.deflection_m;
    F::accept(p, memory, dx, v_mps);
    given_J += 0.5 * (before_N + 1e7 * memory.deflection_m) * dx;
    const double stored_J = 0.5 * 1e7 * memory.deflection_m * memory.deflection_m;
    ASSERT_LE(stored_J, given_J + 1e-9) << i;
  }
}

TEST(Friction, DampingOfTheBristlesFadesWithTheSpeed) {
  F::Parameters p;
  p.coulomb_N = 200.0;
  p.presliding_stiffness_N_per_m = 1e7;
  p.presliding_damping_N_s_per_m = 5000.0;
  for (const double v_mps : {-0.03, -0.004, 0.004, 0.03}) {
    // bristles at rest: the damping alone
    const effects::DryContact<double> at{v_mps, 0.0, 0.0, 5e5};
    p.damping_speed_mps = std::numeric_limits<double>::infinity();
    EXPECT_NEAR(F::friction_N(p, {}, at), 5000.0 * v_mps, 1e-9) << v_mps;
    p.damping_speed_mps = 0.01;
    EXPECT_NEAR(F::friction_N(p, {}, at), 5000.0 * v_mps * std::exp(-std::pow(v_mps / 0.01, 2)),
                1e-9)
        << v_mps;
  }
}

struct Bristle {
  double mass_kg;
  double coulomb_N;
  double static_N;
  double stribeck_mps;
  double stiffness_N_per_m;
  double damping_N_s_per_m;
  double damping_speed_mps;
};

/// Positions every 5 ms of a mass under 120 N sin(2 pi 0.7 t) on LuGre's bristles, by Runge and
/// Kutta's method at 1 us: z' = v - k |v| z / g(v), F = k z + s1 exp(-(v/vd)^2) z'.
std::vector<double> lugre_m(const Bristle& b, int samples) {
  using State = std::array<double, 3>;
  const auto rate = [&](const State& x, double force_N) -> State {
    const double v_mps = x[1];
    const double level_N =
        b.coulomb_N + (b.static_N - b.coulomb_N) * std::exp(-std::pow(v_mps / b.stribeck_mps, 2));
    const double z_mps = v_mps - b.stiffness_N_per_m * std::abs(v_mps) * x[2] / level_N;
    const double damping =
        b.damping_N_s_per_m * std::exp(-std::pow(v_mps / b.damping_speed_mps, 2));
    return {v_mps, (force_N - b.stiffness_N_per_m * x[2] - damping * z_mps) / b.mass_kg, z_mps};
  };
  constexpr double kStep_s = 1e-6;
  State x{};
  std::vector<double> y_m;
  for (int k = 0; k < samples; ++k) {
    y_m.push_back(x[0]);
    const double force_N = 120.0 * std::sin(2.0 * M_PI * 0.7 * 0.005 * k);
    for (int i = 0; i < 5000; ++i) {
      const State a = rate(x, force_N);
      const auto ahead = [&](const State& slope, double by_s) {
        return State{x[0] + by_s * slope[0], x[1] + by_s * slope[1], x[2] + by_s * slope[2]};
      };
      const State c = rate(ahead(a, 0.5 * kStep_s), force_N);
      const State d = rate(ahead(c, 0.5 * kStep_s), force_N);
      const State e = rate(ahead(d, kStep_s), force_N);
      for (std::size_t j = 0; j < 3; ++j) {
        x[j] += kStep_s / 6.0 * (a[j] + 2.0 * c[j] + 2.0 * d[j] + e[j]);
      }
    }
  }
  return y_m;
}

TEST(Friction, TurnsOnItsBristlesWithinASensorsNoiseOfTheirEquation) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const Bristle& b : {Bristle{100.0, 60.0, 60.0, 0.01, 5e6, 0.0, kInfinite},
                           Bristle{100.0, 60.0, 85.0, 0.008, 5e6, 0.0, kInfinite},
                           Bristle{100.0, 60.0, 85.0, 0.008, 5e6, 3000.0, 0.01}}) {
    const std::vector<double> expected_m = lugre_m(b, 600);
    auto axis = at_rest<Axis>();
    axis->parameters.mass_kg = b.mass_kg;
    axis->parameters.damping_N_s_per_m = 0.0;
    axis->parameters.gain_N_per_V = 1.0;
    set_effect(*axis, "friction", "coulomb_N", b.coulomb_N);
    set_effect(*axis, "friction", "static_N", b.static_N);
    set_effect(*axis, "friction", "stribeck_mps", b.stribeck_mps);
    set_effect(*axis, "friction", "presliding_stiffness_N_per_m", b.stiffness_N_per_m);
    set_effect(*axis, "friction", "presliding_damping_N_s_per_m", b.damping_N_s_per_m);
    set_effect(*axis, "friction", "damping_speed_mps", b.damping_speed_mps);
    axis->prepare(1e-3);
    axis->reset();
    const double from_m = axis->state.y_m;
    double worst_m = 0.0;
    double way_m = 0.0;
    for (std::size_t k = 0; k < expected_m.size(); ++k) {
      worst_m = std::max(worst_m, std::abs(axis->state.y_m - from_m - expected_m[k]));
      way_m = std::max(way_m, std::abs(expected_m[k]));
      hold(*axis, 120.0 * std::sin(2.0 * M_PI * 0.7 * 0.005 * static_cast<double>(k)), 0.005);
    }
    EXPECT_GT(way_m, 0.05);
    EXPECT_LT(worst_m, 1e-6) << b.static_N << " " << b.damping_N_s_per_m;
  }
}

TEST(Friction, RunsOfHalvedStepsConverge) {
  const auto position = [](double step_s, double stiffness) {
    auto plant = std::make_unique<Actuator>();
    set_effect(*plant, "friction", "coulomb_N", 200.0);
    set_effect(*plant, "friction", "static_N", 260.0);
    set_effect(*plant, "friction", "stribeck_mps", 0.02);
    set_effect(*plant, "friction", "presliding_stiffness_N_per_m", stiffness);
    plant->prepare(step_s);
    plant->reset();
    for (int k = 0; k < 800; ++k) hold(*plant, 1.5 * std::sin(k * 0.005 * M_PI), 0.005, step_s);
    return plant->state.y_m;
  };
  for (const double stiffness : {0.0, 1e7}) {
    const double exact = position(1e-3 / 16.0, stiffness);
    const double coarse = std::abs(position(1e-3, stiffness) - exact);
    const double fine = std::abs(position(0.25e-3, stiffness) - exact);
    EXPECT_LT(coarse, 1e-5) << stiffness;  // of 0.09 m travelled each way
    EXPECT_LT(fine, 0.5 * coarse) << stiffness;
  }
}

}  // namespace
}  // namespace plant_sim::testing
