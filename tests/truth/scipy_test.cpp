// Against SciPy's solve_ivp at a tolerance of 1e-12: tests/plant_sim/reference.csv, written by the
// reference.py beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/truth/actuator.h"
#include "tests/truth/reference_rows.h"
#include "tests/truth/rig.h"

namespace truth {
namespace {

// Heun's method at 25 us is of second order: it may differ by this much, a twentieth of the noise.
constexpr double kNear_m = 1e-7;
constexpr double kNear_Pa = 3e3;

/// Rows every 10 ms, the voltage held for two samples.
void expect_follows(const std::string& name, const Plant& plant, const Hidden& hidden) {
  Rig rig(std::make_unique<Actuator>(plant, hidden, LeftOut{}));
  // y, v, Pi, Po, spool, spool speed follow t and u
  const auto rows = reference_rows("reference.csv", name);
  ASSERT_GE(rows.size(), 30U);
  double off_m = 0.0;
  double off_Pa = 0.0;
  for (const ReferenceRow& row : rows) {
    off_m = std::max(off_m, std::abs(rig.x[0] - row[2]));
    off_Pa = std::max({off_Pa, std::abs(rig.x[2] - row[4]), std::abs(rig.x[3] - row[5])});
    rig.hold(row[1]);
    rig.hold(row[1]);
  }
  EXPECT_LT(off_m, kNear_m);
  EXPECT_LT(off_Pa, kNear_Pa);
}

TEST(TruthActuator, FollowsSciPyWithThePrintedValues) {
  expect_follows("steps", Plant{}, Hidden{});
}

TEST(TruthActuator, FollowsSciPyWithOtherMassDampingAndSupply) {
  Plant plant;
  plant.mass_kg = 10.0;
  plant.damping_N_s_per_m = 300.0;
  plant.supply_pressure_Pa = 1.379e7;
  expect_follows("stiff", plant, Hidden{});
}

TEST(TruthActuator, FollowsSciPyWithTheEffectsOnOil) {
  Hidden hidden;
  hidden.asymmetry_ratio = 0.08;
  hidden.droop_Pa_per_m3ps = 2e10;
  hidden.internal_m3ps_per_Pa = 3e-12;
  hidden.external_m3ps_per_Pa = 1e-12;
  hidden.air_ratio = 0.01;
  expect_follows("oil", Plant{}, hidden);
}

TEST(TruthActuator, FollowsSciPyWithTheEffectsOnTheRod) {
  Hidden hidden;
  hidden.quadratic_N_s2_per_m2 = 2e4;
  hidden.spring_N_per_m = 2e4;
  hidden.rest_m = 0.3;
  hidden.force_N = 300.0;
  hidden.ripple_N = 100.0;
  hidden.ripple_wavelength_m = 0.01;
  hidden.ripple_phase_rad = 1.0;
  expect_follows("load", Plant{}, hidden);
}

}  // namespace
}  // namespace truth
