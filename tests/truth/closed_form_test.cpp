// Effects against what can be worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "tests/truth/actuator.h"
#include "tests/truth/axis.h"
#include "tests/truth/rig.h"
#include "tests/truth/rod.h"

namespace truth {
namespace {

constexpr int kSettled = 300;  ///< samples after which transients have died away

/// Holds a command until speed and pressures are steady; the rig's speed is then x[1].
Rig settled(const Hidden& hidden, double u_V, const Plant& plant = {}, const LeftOut& left = {}) {
  Rig rig(std::make_unique<Actuator>(plant, hidden, left));
  for (int k = 0; k < kSettled; ++k) rig.hold(u_V);
  return rig;
}

/// Steady speed through two orifices in series with the load pressure, which only viscous and given
/// forces make: v = g sqrt((Ps - F/A)/2)/A, F = d v + extra(v); by repeated substitution.
double steady_mps(double opening_V, const std::function<double(double)>& extra_N = {},
                  const Plant& p = {}) {
  const double g = p.discharge_coefficient * p.area_gradient_m * p.valve_gain_m_per_V * opening_V *
                   std::sqrt(2.0 / p.density_kg_per_m3);
  double v = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double force_N = p.damping_N_s_per_m * v + (extra_N ? extra_N(v) : 0.0);
    v = g * std::sqrt((p.supply_pressure_Pa - force_N / p.area_m2) / 2.0) / p.area_m2;
  }
  return v;
}

TEST(TruthActuator, MovesAtTheSteadySpeedOfItsOrifices) {
  const double expected = steady_mps(1.0);
  EXPECT_NEAR(settled({}, 1.0).x[1], expected, 1e-4 * expected);
}

TEST(TruthActuator, ExtendsOnAPositiveCommand) { EXPECT_GT(settled({}, 0.5).x[0], 0.306); }

struct Maker {
  const char* name;
  double mass_kg;
  std::function<std::unique_ptr<Machine>(const Hidden&)> make;
};

std::vector<Maker> makers() {
  return {{"actuator", Plant{}.mass_kg,
           [](const Hidden& h) { return std::make_unique<Actuator>(Plant{}, h, LeftOut{}); }},
          {"axis", AxisPlant{}.mass_kg,
           [](const Hidden& h) { return std::make_unique<Axis>(AxisPlant{}, h, LeftOut{}); }},
          {"single rod", RodPlant{}.mass_kg,
           [](const Hidden& h) { return std::make_unique<Rod>(RodPlant{}, h, LeftOut{}); }}};
}

State moving(const Machine& machine, double v_mps, double z_m) {
  State x = machine.rest(kCentre_m);
  x[1] = v_mps;
  x[6] = z_m;
  return x;
}

/// Friction at a speed, N, by the acceleration that it takes; the bristles are bent by z_m.
double friction_N(const Maker& maker, const Hidden& hidden, double v_mps, double z_m) {
  const auto rubbing = maker.make(hidden);
  const auto smooth = maker.make({});
  return maker.mass_kg * (smooth->rate(moving(*smooth, v_mps, 0.0), 0.0, 0.0)[1] -
                          rubbing->rate(moving(*rubbing, v_mps, z_m), 0.0, 0.0)[1]);
}

TEST(TruthFriction, SlidesSteadilyAtTheLevelOfStribecksCurve) {
  Hidden hidden;
  hidden.coulomb_N = 150.0;
  hidden.static_N = 190.0;
  hidden.stribeck_mps = 0.015;
  for (const Maker& maker : makers()) {
    const auto machine = maker.make(hidden);
    for (const double v_mps : {0.003, 0.015, 0.1, -0.015}) {
      double z_m = 0.0;  // Euler on the bristle alone, at constant speed
      for (int i = 0; i < 400000; ++i) {
        z_m += 1e-6 * machine->rate(moving(*machine, v_mps, z_m), 0.0, 0.0)[6];
      }
      const double level_N = 150.0 + 40.0 * std::exp(-std::pow(v_mps / 0.015, 2));
      EXPECT_NEAR(friction_N(maker, hidden, v_mps, z_m), std::copysign(level_N, v_mps),
                  1e-3 * level_N)
          << maker.name;
    }
  }
}

TEST(TruthFriction, DampsItsBristlesLessTheFasterItSlides) {
  Hidden hidden;
  hidden.coulomb_N = 150.0;
  hidden.bristle_N_s_per_m = 700.0;
  hidden.damping_speed_mps = 0.01;
  for (const Maker& maker : makers()) {
    for (const double v_mps : {-0.02, 0.005, 0.02}) {
      const double ratio = v_mps / 0.01;
      EXPECT_NEAR(friction_N(maker, hidden, v_mps, 0.0), 700.0 * v_mps * std::exp(-ratio * ratio),
                  1e-6)
          << maker.name;
    }
  }
}

Plant undamped_plant() {
  Plant plant;
  plant.damping_N_s_per_m = 0.0;
  return plant;
}

/// Bristles of 1e8 N/m without damping.
Hidden stiff_bristles(double coulomb_N) {
  Hidden hidden;
  hidden.coulomb_N = coulomb_N;
  hidden.presliding_N_per_m = 1e8;
  hidden.bristle_N_s_per_m = 0.0;
  return hidden;
}

TEST(TruthFriction, StaysOnBristlesStifferThanItsSteps) {
  const Actuator actuator(undamped_plant(), stiff_bristles(2.0), LeftOut{});
  // at 0.2 m/s the bristles follow within 0.1 us, a hundredth of the step
  State x = actuator.rest(kCentre_m);
  x[1] = 0.2;
  actuator.step(x, 0.0, 0.0, 1e-5);
  EXPECT_NEAR(1e8 * x[6], 2.0, 0.02);
}

TEST(TruthFriction, TakesFourForcesPerStiffnessFromEachSwingOfTheRod) {
  const Plant plant = undamped_plant();
  const Hidden hidden = stiff_bristles(40.0);
  Rig rig(std::make_unique<Actuator>(plant, hidden, LeftOut{}), 2000);
  rig.x[1] = 0.2;
  double peak_m = 0.0;
  std::vector<double> peaks_m;
  double before = rig.x[0];
  bool rising = true;
  Actuator actuator(plant, hidden, LeftOut{});
  State x = rig.x;
  for (int i = 0; i < 200000; ++i) {
    actuator.step(x, 0.0, 0.0, 5e-7);
    if (rising && x[0] < before) {
      peak_m = before - kCentre_m;
      peaks_m.push_back(peak_m);
    }
    rising = x[0] > before;
    before = x[0];
  }
  ASSERT_GE(peaks_m.size(), 3U);
  const double volume_m3 = plant.dead_volume_m3 + plant.area_m2 * kCentre_m;
  const double stiffness = 2.0 * plant.bulk_modulus_Pa * plant.area_m2 * plant.area_m2 / volume_m3;
  const double expected_m = 4.0 * hidden.coulomb_N / stiffness;
  EXPECT_NEAR(peaks_m[0] - peaks_m[1], expected_m, 0.02 * expected_m);
  EXPECT_NEAR(peaks_m[1] - peaks_m[2], expected_m, 0.02 * expected_m);
}

TEST(TruthLeakage, LetsAPushedRodCreepBehindAClosedValve) {
  Hidden hidden;
  hidden.force_N = 500.0;
  hidden.internal_m3ps_per_Pa = 1.4e-11;
  const Plant p;
  // A dP = F + d v, A v = -C dP
  const double c = hidden.internal_m3ps_per_Pa;
  const double expected = -c * hidden.force_N / (p.area_m2 * p.area_m2 + c * p.damping_N_s_per_m);
  EXPECT_NEAR(settled(hidden, 0.0).x[1], expected, 1e-3 * std::abs(expected));
}

TEST(TruthEffects, ChangeTheSteadySpeedAsTheirEquationsSay) {
  const auto expect = [](const Hidden& hidden, double u_V, double expected, const char* what) {
    EXPECT_NEAR(settled(hidden, u_V).x[1], expected, 2e-4 * std::abs(expected) + 1e-9) << what;
  };
  const auto with = [](double Hidden::*member, double value) {
    Hidden hidden;
    hidden.*member = value;
    return hidden;
  };
  expect(with(&Hidden::null_bias_V, 0.3), 1.0, steady_mps(1.3), "null bias");
  expect(with(&Hidden::hysteresis_V, 0.2), 1.0, steady_mps(0.8), "hysteresis");
  expect(with(&Hidden::deadband_V, 0.2), 1.0, steady_mps(0.8), "deadband");
  expect(with(&Hidden::deadband_V, 0.2), 0.15, 0.0, "inside the deadband");
  expect(with(&Hidden::asymmetry_ratio, 0.1), 1.0, steady_mps(1.1), "asymmetry, out");
  expect(with(&Hidden::asymmetry_ratio, 0.1), -1.0, -steady_mps(0.9), "asymmetry, in");
  expect(with(&Hidden::flow_limit_m3ps, 2e-5), 1.0, 2e-5 / 6.33e-4, "flow limit");
  expect(with(&Hidden::force_N, 200.0), 1.0, steady_mps(1.0, [](double) { return 200.0; }), "load");
  expect(with(&Hidden::quadratic_N_s2_per_m2, 2e4), 1.0,
         steady_mps(1.0, [](double v) { return 2e4 * v * v; }), "quadratic damping");
  expect(with(&Hidden::needle_N_s2_per_m2, 2e4), 1.0,
         steady_mps(1.0, [](double v) { return 2e4 * v * v; }), "needle");
  expect(with(&Hidden::coulomb_N, 150.0), 1.0, steady_mps(1.0, [](double) { return 150.0; }),
         "friction");
  // Droop lowers Ps by D A v: the load pressure equation with an extra "force" D A^2 v.
  expect(with(&Hidden::droop_Pa_per_m3ps, 1e10), 1.0,
         steady_mps(1.0, [](double v) { return 1e10 * 6.33e-4 * 6.33e-4 * v; }), "droop");
}

TEST(TruthEffects, LimitTheSpoolToItsRate) {
  Hidden hidden;
  hidden.spool_rate_mps = 1e-4;
  Rig rig(std::make_unique<Actuator>(Plant{}, hidden, LeftOut{}));
  for (int k = 0; k < 10; ++k) rig.hold(5.0);
  EXPECT_NEAR(rig.x[4], 1e-4 * 0.05, 0.02 * 1e-4 * 0.05);
  EXPECT_NEAR(rig.x[5], 1e-4, 1e-9);
}

TEST(TruthEffects, DelayTheCommandByAnyTime) {
  Hidden late;
  late.delay_s = 0.0075;
  Rig delayed(std::make_unique<Actuator>(Plant{}, late, LeftOut{}));
  Rig prompt(std::make_unique<Actuator>(Plant{}, Hidden{}, LeftOut{}));
  for (int k = 0; k < kSettled; ++k) delayed.hold(1.0);
  for (int k = 0; k < kSettled; ++k) prompt.hold(1.0);
  EXPECT_NEAR(prompt.x[0] - delayed.x[0], 0.0075 * prompt.x[1], 1e-3 * 0.0075 * prompt.x[1]);
}

TEST(TruthEffects, ReadThroughPlayAndAnEccentricWheel) {
  Hidden play;
  play.backlash_m = 1e-4;
  Rig rig = settled(play, 1.0);
  EXPECT_NEAR(rig.reading_m(), rig.x[0] - 0.5e-4, 1e-12);
  Hidden wheel;
  wheel.eccentricity_m = 5e-5;
  wheel.eccentricity_wavelength_m = 0.02;
  wheel.eccentricity_phase_rad = 0.3;
  rig = settled(wheel, 1.0);
  EXPECT_NEAR(rig.reading_m() - rig.x[0],
              5e-5 * std::sin(2.0 * 3.14159265358979 * rig.x[0] / 0.02 + 0.3), 1e-12);
}

// A closed valve whose edges are open by U lets a load F move the rod at A v = c U (sqrt(Ps - F/A)
// - sqrt(Ps + F/A)), c = Cd w/sqrt(rho): by repeated substitution, F with the viscous force.
TEST(TruthLeftOut, LetsALoadMoveTheRodPastAnOpenCentre) {
  Hidden hidden;
  hidden.force_N = 1500.0;
  const Plant p;
  const double c = p.discharge_coefficient * p.area_gradient_m * p.valve_gain_m_per_V * 0.2 /
                   std::sqrt(p.density_kg_per_m3);
  double v = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double load_Pa = (1500.0 + p.damping_N_s_per_m * v) / p.area_m2;
    v = c *
        (std::sqrt(p.supply_pressure_Pa - load_Pa) - std::sqrt(p.supply_pressure_Pa + load_Pa)) /
        p.area_m2;
  }
  EXPECT_LT(v, -1e-3);
  const LeftOut left{LeftOut::Kind::open_centre, 0.2, 0.0};
  EXPECT_NEAR(settled(hidden, 0.0, p, left).x[1], v, 1e-3 * std::abs(v));
}

TEST(TruthLeftOut, ResistsWithTheCubeOfTheSpeed) {
  const LeftOut cubic{LeftOut::Kind::cubic_damping, 2.5e5, 0.0};
  const double expected = steady_mps(2.0, [](double v) { return 2.5e5 * v * v * v; });
  EXPECT_NEAR(settled({}, 2.0, {}, cubic).x[1], expected, 2e-4 * expected);
}

}  // namespace
}  // namespace truth
