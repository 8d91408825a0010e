// The single-rod cylinder against what can be worked out by hand.
#include "tests/truth/rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "tests/truth/rig.h"

namespace truth {
namespace {

constexpr double kPi = 3.14159265358979;

/// Mean over a second, behind a second in which pressures settle: without damping they ring.
double settled_mps(const RodPlant& plant, const Hidden& hidden, double u_V) {
  Rig rig(std::make_unique<Rod>(plant, hidden, LeftOut{}));
  for (int k = 0; k < 200; ++k) rig.hold(u_V);
  const double from_m = rig.x[0];
  for (int k = 0; k < 200; ++k) rig.hold(u_V);
  return rig.x[0] - from_m;
}

/// Speed at which an opening passes what both areas displace, by repeated substitution; load_N and
/// droop_Pa of the speed.
double steady_mps(const RodPlant& p, double opening_V, const std::function<double(double)>& load_N,
                  double droop_Pa_per_m3ps = 0.0) {
  const double areas = std::pow(p.area_cap_m2, 3) + std::pow(p.area_rod_m2, 3);
  const bool out = opening_V > 0.0;
  const double fed_m2 = out ? p.area_cap_m2 : p.area_rod_m2;
  const double other_m2 = out ? p.area_rod_m2 : p.area_cap_m2;
  double v = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double supply_Pa = p.supply_pressure_Pa - droop_Pa_per_m3ps * fed_m2 * std::abs(v);
    const double against_N = (out ? 1.0 : -1.0) * load_N(v) + p.damping_N_s_per_m * std::abs(v);
    const double next =
        p.flow_m3ps_per_V_rootPa * opening_V *
        std::sqrt((fed_m2 * supply_Pa - other_m2 * p.return_pressure_Pa - against_N) / areas);
    v = 0.5 * (v + next);
  }
  return v;
}

double nothing(double) { return 0.0; }

TEST(TruthRod, ExtendsAndRetractsAtTheSpeedsOfItsTwoAreas) {
  const RodPlant p;
  for (const double u_V : {0.8, 2.0, -0.8, -2.0}) {
    const double expected = steady_mps(p, u_V, nothing);
    EXPECT_NEAR(settled_mps(p, {}, u_V), expected, 1e-4 * std::abs(expected)) << u_V;
  }
}

TEST(TruthRod, IsAsUnevenAsItsAreasAndLoadSay) {
  for (const double load_N : {0.0, 2000.0, -2000.0}) {
    RodPlant p;
    p.damping_N_s_per_m = 0.0;
    Hidden hidden;
    hidden.force_N = load_N;
    const double out = settled_mps(p, hidden, 1.0);
    const double in = -settled_mps(p, hidden, -1.0);
    EXPECT_NEAR((out - in) / (out + in), speed_asymmetry(p, load_N), 1e-4);
  }
  EXPECT_NEAR(speed_asymmetry(RodPlant{}, 0.0), 0.1337, 1e-3);  // (r - 1)/(r + 1), r^2 = 27.64/16.2
  RodPlant even;
  even.area_rod_m2 = even.area_cap_m2;
  EXPECT_NEAR(speed_asymmetry(even, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(settled_mps(even, {}, 1.0), -settled_mps(even, {}, -1.0), 1e-6);
}

TEST(TruthRod, StandsInsideTheOverlapAndIsSlowerByItOutside) {
  Hidden hidden;
  hidden.deadband_V = 0.4;
  EXPECT_NEAR(settled_mps({}, hidden, 0.35), 0.0, 1e-9);
  for (const double sign : {1.0, -1.0}) {
    const double expected = steady_mps({}, sign * 0.6, nothing);
    EXPECT_NEAR(settled_mps({}, hidden, sign * 1.0), expected, 1e-4 * std::abs(expected));
  }
}

TEST(TruthRod, LosesSpeedToDroopFrictionAndLoad) {
  Hidden droop;
  droop.droop_Pa_per_m3ps = 1.5e10;
  Hidden friction;
  friction.coulomb_N = 300.0;
  Hidden load;
  load.force_N = 1500.0;
  for (const double u_V : {1.5, -1.5}) {
    const double drooping = steady_mps({}, u_V, nothing, 1.5e10);
    EXPECT_NEAR(settled_mps({}, droop, u_V), drooping, 1e-4 * std::abs(drooping)) << u_V;
    const double rubbing = steady_mps({}, u_V, [&](double) { return std::copysign(300.0, u_V); });
    EXPECT_NEAR(settled_mps({}, friction, u_V), rubbing, 1e-4 * std::abs(rubbing)) << u_V;
    const double loaded = steady_mps({}, u_V, [](double) { return 1500.0; });
    EXPECT_NEAR(settled_mps({}, load, u_V), loaded, 1e-4 * std::abs(loaded)) << u_V;
  }
}

TEST(TruthRod, RestsUnderItsLoad) {
  Hidden hidden;
  hidden.force_N = 1500.0;
  Rig rig(std::make_unique<Rod>(RodPlant{}, hidden, LeftOut{}));
  for (int k = 0; k < 20; ++k) rig.hold(0.0);
  EXPECT_NEAR(rig.x[0], kCentre_m, 1e-12);
}

TEST(TruthRod, SwingsOnTheOilOfBothChambers) {
  RodPlant p;
  p.damping_N_s_per_m = 0.0;
  const Rod rod(p, {}, {});
  State x = rod.rest(kCentre_m);
  x[1] = 1e-3;  // so little that the volumes stay
  const double cap_m3 = p.dead_volume_m3 + p.area_cap_m2 * kCentre_m;
  const double rod_m3 = p.dead_volume_m3 + p.area_rod_m2 * (p.stroke_m - kCentre_m);
  const double stiffness = p.bulk_modulus_Pa * (p.area_cap_m2 * p.area_cap_m2 / cap_m3 +
                                                p.area_rod_m2 * p.area_rod_m2 / rod_m3);
  const double w = std::sqrt(stiffness / p.mass_kg);
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) rod.step(x, 0.0, 0.0, 0.5 * kPi / w / kSteps);
  EXPECT_NEAR(x[1], 0.0, 1e-7);
  EXPECT_NEAR(x[0] - kCentre_m, 1e-3 / w, 1e-4 * 1e-3 / w);
}

TEST(TruthRod, MovesItsSpoolAsASecondOrder) {
  const RodPlant p;
  Rig rig(std::make_unique<Rod>(p, Hidden{}, LeftOut{}));
  for (int k = 0; k < 2; ++k) rig.hold(1.0);
  const double w = p.valve_natural_frequency_rad_per_s;
  const double z = p.valve_damping_ratio;
  const double rings = w * std::sqrt(1.0 - z * z);
  const double t_s = 0.01;
  const double expected =
      1.0 - std::exp(-z * w * t_s) *
                (std::cos(rings * t_s) + z / std::sqrt(1.0 - z * z) * std::sin(rings * t_s));
  EXPECT_NEAR(rig.x[4], expected, 1e-5);
}

}  // namespace
}  // namespace truth
