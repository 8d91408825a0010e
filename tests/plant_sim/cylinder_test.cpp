// A cylinder of two areas against closed forms, against the double rod, and against SciPy's
// solve_ivp at a tolerance of 1e-12 (cylinder_reference.csv, written by cylinder_reference.py).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "plant_sim/hydraulics.h"
#include "tests/plant_sim/support.h"
#include "tests/truth/reference_rows.h"

namespace plant_sim::testing {
namespace {

using Cylinder = HydraulicCylinder<double>;
constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity_mps2 = 9.80665;

std::unique_ptr<Cylinder> ready(const Cylinder::Parameters& p, double step_s = 1e-4) {
  auto plant = std::make_unique<Cylinder>();
  plant->parameters = p;
  plant->prepare(step_s);
  plant->reset();
  return plant;
}

/// -3 dB frequency of a second order.
double bandwidth_Hz(double wv_rad_per_s, double zeta) {
  const double half = 1.0 - 2.0 * zeta * zeta;
  return wv_rad_per_s / (2.0 * kPi) * std::sqrt(half + std::sqrt(half * half + 1.0));
}

/// Steady speed of an opening (as a command) against a load, without damping: both edges pass what
/// the areas displace.
double steady_mps(const Cylinder::Parameters& p, double u_V, double load_N) {
  const double k = p.rated_flow_m3ps / std::sqrt(p.rated_drop_Pa) * u_V / p.rated_command_V;
  const double cubes = std::pow(p.cap_area_m2, 3) +
                       std::pow(p.rod_side_area_m2, 3) / std::pow(p.valve_area_ratio, 2);
  const double out_N =
      p.cap_area_m2 * p.supply_pressure_Pa - p.rod_side_area_m2 * p.return_pressure_Pa - load_N;
  const double in_N =
      p.rod_side_area_m2 * p.supply_pressure_Pa - p.cap_area_m2 * p.return_pressure_Pa + load_N;
  return k * std::sqrt((u_V > 0.0 ? out_N : in_N) / cubes);
}

TEST(HydraulicCylinder, ExtendsAndRetractsAtTheSpeedsOfItsTwoAreas) {
  for (const double ratio : {1.0, 0.6}) {
    for (const double load_N : {0.0, 4000.0, -3000.0}) {
      std::array<double, 2> speed{};
      for (const double u_V : {1.0, -1.0}) {
        Cylinder::Parameters p;
        p.damping_N_s_per_m = 0.0;
        p.valve_area_ratio = ratio;
        auto plant = ready(p);
        set_effect(*plant, "load_force", "force_N", load_N);
        // without damping pressures ring for long: a bypass takes their energy, then goes
        set_effect(*plant, "internal_leakage", "conductance_m3ps_per_Pa", 2e-11);
        hold(*plant, u_V, 0.5, 1e-4);
        set_effect(*plant, "internal_leakage", "conductance_m3ps_per_Pa", 0.0);
        hold(*plant, u_V, 1.0, 1e-4);
        const double from_m = plant->state.y_m;
        hold(*plant, u_V, 0.5, 1e-4);
        speed[u_V > 0.0 ? 0 : 1] = (plant->state.y_m - from_m) / 0.5;
        const double expected = steady_mps(p, u_V, load_N);
        EXPECT_NEAR(speed[u_V > 0.0 ? 0 : 1], expected, 2e-4 * std::abs(expected))
            << ratio << " " << load_N << " " << u_V;
      }
      const Cylinder::Parameters p;
      const double out_N =
          p.cap_area_m2 * p.supply_pressure_Pa - p.rod_side_area_m2 * p.return_pressure_Pa - load_N;
      const double in_N =
          p.rod_side_area_m2 * p.supply_pressure_Pa - p.cap_area_m2 * p.return_pressure_Pa + load_N;
      EXPECT_NEAR(-speed[0] / speed[1], std::sqrt(out_N / in_N), 4e-4);  // whatever the valve
    }
  }
}

TEST(HydraulicCylinder, RestsWithThePressuresThatCarryWeightAndLoad) {
  Cylinder::Parameters p;
  p.inclination_rad = 0.4;
  auto plant = ready(p);
  set_effect(*plant, "load_force", "force_N", 1200.0);
  set_effect(*plant, "load_spring", "stiffness_N_per_m", 1e4);
  set_effect(*plant, "load_spring", "rest_m", 0.1);
  set_effect(*plant, "friction", "coulomb_N", 500.0);
  plant->prepare(1e-3);
  plant->reset();
  const double load_N = p.mass_kg * kGravity_mps2 * std::sin(0.4) + 1200.0 + 1e4 * 0.15;
  const double in_Pa = plant->state.in_Pa;
  const double out_Pa = plant->state.out_Pa;
  EXPECT_NEAR(p.cap_area_m2 * in_Pa - p.rod_side_area_m2 * out_Pa, load_N, 1e-6);
  EXPECT_NEAR(in_Pa + out_Pa, p.supply_pressure_Pa + p.return_pressure_Pa, 1e-3);
  set_effect(*plant, "friction", "coulomb_N", 0.0);
  hold(*plant, 0.0, 1.0);
  EXPECT_NEAR(plant->state.y_m, 0.25, 1e-12);
  EXPECT_NEAR(plant->state.in_Pa, in_Pa, 1e-3);
}

TEST(HydraulicCylinder, StartsWithinSupplyAndReturnUnderALoadThatItCannotCarry) {
  for (const double load_N : {1e6, -1e6}) {
    auto plant = ready({});
    set_effect(*plant, "load_force", "force_N", load_N);
    plant->prepare(1e-3);
    plant->reset();
    const Cylinder::Parameters& p = plant->parameters;
    EXPECT_EQ(plant->state.in_Pa, load_N > 0.0 ? p.supply_pressure_Pa : p.return_pressure_Pa);
    EXPECT_EQ(plant->state.out_Pa, load_N > 0.0 ? p.return_pressure_Pa : p.supply_pressure_Pa);
  }
}

TEST(HydraulicCylinder, TakesGivenPressuresAsTheyAre) {
  auto plant = std::make_unique<Cylinder>();
  plant->initial.pressure_in_Pa = 5e6;
  plant->prepare(1e-3);
  plant->reset();
  EXPECT_EQ(plant->state.in_Pa, 5e6);
  EXPECT_GT(plant->state.out_Pa, 8e6);
}

TEST(HydraulicCylinder, SwingsOnTheOilOfBothVolumes) {
  Cylinder::Parameters p;
  p.damping_N_s_per_m = 0.0;
  p.rod_dead_volume_m3 = 3e-4;
  auto plant = ready(p, 1e-5);
  plant->state.v_mps = 1e-3;  // so little that the volumes stay
  const double cap_m3 = p.cap_dead_volume_m3 + p.cap_area_m2 * 0.25;
  const double rod_m3 = p.rod_dead_volume_m3 + p.rod_side_area_m2 * (p.stroke_m - 0.25);
  const double w = std::sqrt(
      p.bulk_modulus_Pa *
      (std::pow(p.cap_area_m2, 2) / cap_m3 + std::pow(p.rod_side_area_m2, 2) / rod_m3) / p.mass_kg);
  const double before_s = 1e-5 * std::floor(0.5 * kPi / w / 1e-5);
  hold(*plant, 0.0, before_s, 1e-5);
  EXPECT_NEAR(plant->state.v_mps, 1e-3 * std::cos(w * before_s), 1e-8);
  EXPECT_NEAR(plant->state.y_m - 0.25, 1e-3 / w * std::sin(w * before_s), 1e-4 * 1e-3 / w);
}

TEST(HydraulicCylinder, IsTheDoubleRodWhereBothAreasAreEqual) {
  Actuator actuator;
  const Actuator::Parameters& a = actuator.parameters;
  Cylinder cylinder;
  Cylinder::Parameters& c = cylinder.parameters;
  c.mass_kg = a.mass_kg;
  c.cap_area_m2 = c.rod_side_area_m2 = a.area_m2;
  c.damping_N_s_per_m = a.damping_N_s_per_m;
  c.bulk_modulus_Pa = a.bulk_modulus_Pa;
  c.cap_dead_volume_m3 = c.rod_dead_volume_m3 = a.dead_volume_m3;
  c.stroke_m = a.stroke_m;
  c.supply_pressure_Pa = a.supply_pressure_Pa;
  c.return_pressure_Pa = a.return_pressure_Pa;
  c.rated_drop_Pa = 3.5e6;
  c.rated_command_V = 10.0;
  c.rated_travel_m = a.valve_gain_m_per_V * c.rated_command_V;
  c.rated_flow_m3ps = a.discharge_coefficient * a.area_gradient_m *
                      std::sqrt(2.0 / a.density_kg_per_m3) * c.rated_travel_m *
                      std::sqrt(c.rated_drop_Pa);
  c.valve_bandwidth_Hz = bandwidth_Hz(a.valve_natural_frequency_rad_per_s, a.valve_damping_ratio);
  c.valve_damping_ratio = a.valve_damping_ratio;
  cylinder.initial.y_m = actuator.initial.y_m;
  const auto both = [&](const char* effect, const char* name, double value) {
    ASSERT_TRUE(set_effect(actuator, effect, name, value) &&
                set_effect(cylinder, effect, name, value));
  };
  both("supply_droop", "droop_Pa_per_m3ps", 2e10);
  both("internal_leakage", "conductance_m3ps_per_Pa", 3e-12);
  both("external_leakage", "conductance_m3ps_per_Pa", 1e-12);
  both("entrained_air", "fraction_ratio", 0.01);
  both("flow_asymmetry", "asymmetry_ratio", 0.05);
  both("deadband", "half_width_V", 0.1);
  both("friction", "coulomb_N", 150.0);
  constexpr double kStep_s = 1e-3;
  actuator.prepare(kStep_s);
  actuator.reset();
  cylinder.prepare(kStep_s);
  cylinder.reset();
  EXPECT_NEAR(cylinder.state.in_Pa, actuator.state.in_Pa, 1e-6);
  double most_m = 0.0;
  double most_Pa = 0.0;
  for (int k = 0; k < 6000; ++k) {  // into both stops
    const double u_V = 2.0 * std::sin(k * 0.002) + 0.5 * std::sin(k * 0.031);
    actuator.step(u_V);
    cylinder.step(u_V);
    most_m = std::max(most_m, std::abs(actuator.state.y_m - cylinder.state.y_m));
    most_Pa = std::max(most_Pa, std::abs(actuator.state.in_Pa - cylinder.state.in_Pa));
  }
  // rounding decides at a reversal whether a step is divided: 2 m/s2 over (step / 16)^2
  EXPECT_LT(most_m, 1e-8);
  EXPECT_LT(most_Pa, 20.0);
}

/// The spool's amplitude per command at a frequency, as the cylinder's step integrates it.
double amplitude_ratio(const Cylinder::Parameters& p, double frequency_Hz) {
  constexpr double kStep_s = 1e-4;
  auto plant = ready(p, kStep_s);
  double most_m = 0.0;
  const int steps = static_cast<int>(10.0 / frequency_Hz / kStep_s);
  for (int k = 0; k < steps; ++k) {
    plant->step(0.01 * std::sin(2.0 * kPi * frequency_Hz * (k + 0.5) * kStep_s));
    if (k > steps / 2) most_m = std::max(most_m, std::abs(plant->state.spool_m));
  }
  return most_m / (0.01 * p.rated_travel_m / p.rated_command_V);
}

TEST(HydraulicCylinder, HasASpoolThatFollowsByMinus3dBAtItsBandwidthWhateverItsDamping) {
  for (const double zeta : {0.4, 0.7, 1.0, 3.0, 5.0, 10.0, 100.0}) {
    Cylinder::Parameters p;
    p.valve_bandwidth_Hz = 25.0;
    p.valve_damping_ratio = zeta;
    EXPECT_NEAR(amplitude_ratio(p, 25.0), std::sqrt(0.5), 2e-3) << zeta;
  }
}

TEST(HydraulicCylinder, HasAFirstOrderLagFromADampingOf10On) {
  Cylinder::Parameters p;
  p.valve_bandwidth_Hz = 8.0;
  for (const double zeta : {10.0, 100.0}) {
    p.valve_damping_ratio = zeta;
    auto plant = ready(p, 5e-4);
    for (int k = 1; k <= 100; ++k) {
      plant->step(1.0);
      const double expected = 1e-4 * (1.0 - std::exp(-2.0 * kPi * 8.0 * k * 5e-4));
      EXPECT_NEAR(plant->state.spool_m, expected, 3e-3 * 1e-4) << zeta << " " << k;
    }
  }
}

/// An underdamped spool is one at any step: its step response at 5 ms, by the closed form, as the
/// bandwidth passes what a whole step resolves.
TEST(HydraulicCylinder, HasAnUnderdampedSpoolAtCoarseSteps) {
  for (const double zeta : {0.4, 0.7, 0.9}) {
    for (double frequency_Hz = 60.0; frequency_Hz < 300.0; frequency_Hz += 7.0) {
      Cylinder::Parameters p;
      p.valve_bandwidth_Hz = frequency_Hz;
      p.valve_damping_ratio = zeta;
      auto plant = ready(p, 5e-3);
      plant->step(1.0);
      const double k = 2.0 * zeta * zeta - 1.0;
      const double wv = 2.0 * kPi * frequency_Hz * std::sqrt(k + std::sqrt(k * k + 1.0));
      const double rings = wv * std::sqrt(1.0 - zeta * zeta);
      const double expected =
          1.0 - std::exp(-zeta * wv * 5e-3) *
                    (std::cos(rings * 5e-3) + zeta * wv / rings * std::sin(rings * 5e-3));
      EXPECT_NEAR(plant->state.spool_m / 1e-4, expected, 0.07) << zeta << " " << frequency_Hz;
    }
  }
}

/// A fit of bandwidth or damping meets no jump, neither where a step can no longer be whole nor at
/// the damping from which the spool is a lag.
TEST(HydraulicCylinder, MovesTheSameWhereverTheSpoolsDynamicsAreDividedOrLeftOut) {
  const auto position_m = [](double frequency_Hz, double zeta) {
    Cylinder::Parameters p;
    p.valve_bandwidth_Hz = frequency_Hz;
    p.valve_damping_ratio = zeta;
    auto plant = ready(p, 2e-3);
    for (int k = 0; k < 200; ++k) plant->step(4.0 * std::sin(0.05 * k));
    return plant->state.y_m;
  };
  for (const double zeta : {0.5, 0.8, 1.0, 2.0, 5.0}) {
    for (double frequency_Hz = 5.0; frequency_Hz < 400.0; frequency_Hz *= 1.01) {
      const double step_m = position_m(frequency_Hz * 1.001, zeta) - position_m(frequency_Hz, zeta);
      // a thousandth more bandwidth is a thousandth less lag, which is as 1 / bandwidth
      EXPECT_LT(std::abs(step_m) * frequency_Hz, 2e-4) << zeta << " " << frequency_Hz;
    }
  }
  for (const double frequency_Hz : {2.0, 20.0, 100.0}) {
    const double step_m = position_m(frequency_Hz, 10.001) - position_m(frequency_Hz, 9.999);
    EXPECT_LT(std::abs(step_m), 5e-6) << frequency_Hz;
  }
}

TEST(HydraulicCylinder, HasASecondOrderWhereItsFasterPoleIsToBeSeen) {
  Cylinder::Parameters p;
  p.valve_damping_ratio = 2.0;
  p.valve_bandwidth_Hz = bandwidth_Hz(100.0, 2.0);
  auto plant = ready(p, 5e-4);
  hold(*plant, 1.0, 0.02, 5e-4);
  // poles at wv (zeta -+ sqrt(zeta^2 - 1))
  const double slow = 100.0 * (2.0 - std::sqrt(3.0));
  const double fast = 100.0 * (2.0 + std::sqrt(3.0));
  const double expected =
      1.0 - (fast * std::exp(-slow * 0.02) - slow * std::exp(-fast * 0.02)) / (fast - slow);
  EXPECT_NEAR(plant->state.spool_m / 1e-4, expected, 1e-5);
}

TEST(HydraulicCylinder, PassesTheRatedFlowAtTheRatedDrop) {
  ModelFile model;
  model.plant = "hydraulic_cylinder";
  model.parameters.clear();
  const Hydraulics oil = hydraulics_of(model).value();
  EXPECT_NEAR(oil.orifice * oil.valve_gain_m_per_V * 10.0 * std::sqrt(3.5e6), 6.667e-4, 1e-15);
  EXPECT_EQ(oil.gain_parameter, "rated_flow_m3ps");
  EXPECT_EQ(oil.area_m2, 1.963e-3);
}

/// The rig of cylinder_reference.py.
Cylinder::Parameters reference_rig() {
  Cylinder::Parameters p;
  p.cap_area_m2 = 0.25 * kPi * 0.05 * 0.05;
  p.rod_side_area_m2 = p.cap_area_m2 - 0.25 * kPi * 0.032 * 0.032;
  p.damping_N_s_per_m = 3000.0;
  p.rod_dead_volume_m3 = 3e-4;
  p.rated_flow_m3ps = 40.0 / 60000.0;
  p.valve_bandwidth_Hz = bandwidth_Hz(150.0, 0.8);
  p.valve_damping_ratio = 0.8;
  return p;
}

void expect_as_scipy(const std::string& of, Cylinder& plant, double step_s) {
  plant.prepare(step_s);
  plant.reset();
  const auto rows = truth::reference_rows("cylinder_reference.csv", of);
  ASSERT_EQ(rows.size(), 70U);
  for (const truth::ReferenceRow& row : rows) {
    const auto& x = plant.state;
    // at a valve reversal the kink of the flow falls inside a step
    ASSERT_NEAR(x.y_m, row[2], 2e-9) << row[0];
    ASSERT_NEAR(x.v_mps, row[3], 1e-6) << row[0];
    ASSERT_NEAR(x.in_Pa, row[4], 20.0) << row[0];
    ASSERT_NEAR(x.out_Pa, row[5], 20.0) << row[0];
    ASSERT_NEAR(x.spool_m * 1e4, row[6], 1e-8) << row[0];
    hold(plant, row[1], 0.01, step_s);
  }
}

TEST(HydraulicCylinder, FollowsSciPyInOpenLoop) {
  Cylinder plant;
  plant.parameters = reference_rig();
  expect_as_scipy("plain", plant, 2.5e-5);
}

TEST(HydraulicCylinder, FollowsSciPyOnAnInclinedAxisWithEffectsOnBothSides) {
  Cylinder plant;
  plant.parameters = reference_rig();
  plant.parameters.valve_area_ratio = 0.6;
  plant.parameters.inclination_rad = 0.5;
  set_effect(plant, "internal_leakage", "conductance_m3ps_per_Pa", 5e-12);
  set_effect(plant, "external_leakage", "conductance_m3ps_per_Pa", 2e-12);
  set_effect(plant, "supply_droop", "droop_Pa_per_m3ps", 5e9);
  set_effect(plant, "entrained_air", "fraction_ratio", 0.01);
  set_effect(plant, "load_force", "force_N", 1500.0);
  set_effect(plant, "load_spring", "stiffness_N_per_m", 2e4);
  set_effect(plant, "load_spring", "rest_m", 0.2);
  expect_as_scipy("full", plant, 2.5e-5);
}

TEST(HydraulicCylinder, FollowsSciPyBehindAnUnderlappedValveOfTwoOpenings) {
  Cylinder plant;
  plant.parameters = reference_rig();
  plant.parameters.valve_area_ratio = 0.6;
  set_effect(plant, "underlap", "half_width_V", 0.15);
  set_effect(plant, "load_force", "force_N", 1500.0);
  expect_as_scipy("lapped", plant, 2.5e-5);
}

TEST(HydraulicCylinder, FollowsSciPyWithinItsEndCushions) {
  Cylinder plant;
  plant.parameters = reference_rig();
  plant.parameters.retracted_cushion_length_m = 0.5;
  plant.parameters.retracted_cushion_flow_m3ps = 1e-4;
  plant.parameters.extended_cushion_length_m = 0.5;
  plant.parameters.extended_cushion_flow_m3ps = 8e-5;
  set_effect(plant, "load_force", "force_N", 8000.0);
  expect_as_scipy("cushioned", plant, 2.5e-5);
}

}  // namespace
}  // namespace plant_sim::testing
