// Against SciPy's solve_ivp at a tolerance of 1e-12: reference.csv, written by reference.py.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/plant_sim/support.h"
#include "tests/truth/reference_rows.h"

namespace plant_sim::testing {
namespace {

using Row = truth::ReferenceRow;  // t, u, then the six states

std::vector<Row> reference(const std::string& name) {
  return truth::reference_rows("reference.csv", name);
}

/// Largest differences from the reference of position, speed (relative to 0.1 m/s) and pressure
/// (relative to 1 MPa).
struct Difference {
  double y_m = 0.0, speed = 0.0, pressure = 0.0;
  void take(const Actuator::State& x, const Row& row) {
    y_m = std::max(y_m, std::abs(x.y_m - row[2]));
    speed = std::max(speed, std::abs(x.v_mps - row[3]) / 0.1);
    pressure =
        std::max({pressure, std::abs(x.in_Pa - row[4]) / 1e6, std::abs(x.out_Pa - row[5]) / 1e6});
  }
};

/// Open-loop cases give a row every 10 ms with the voltage held for two samples.
Difference open_loop(const std::vector<Row>& rows, Actuator& plant, double step_s) {
  Difference worst;
  for (const Row& row : rows) {
    worst.take(plant.state, row);
    hold(plant, row[1], 0.01, step_s);
  }
  return worst;
}

TEST(HydraulicActuator, FollowsSciPyInOpenLoopWithAFineStep) {
  auto plant = at_rest();
  const Difference fine = open_loop(reference("steps"), *plant, 1e-4);
  EXPECT_LT(fine.y_m, 1e-9);  // at a valve reversal the root's kink falls inside a step
  EXPECT_LT(fine.speed, 1e-6);
  EXPECT_LT(fine.pressure, 1e-6);
}

TEST(HydraulicActuator, FollowsSciPyInOpenLoopAtOneMillisecond) {
  auto plant = at_rest();
  const Difference worst = open_loop(reference("steps"), *plant, 1e-3);
  EXPECT_LT(worst.y_m, 5e-7);
  EXPECT_LT(worst.speed, 5e-3);
  EXPECT_LT(worst.pressure, 5e-3);
}

TEST(HydraulicActuator, FollowsSciPyWithOtherParameters) {
  auto plant = std::make_unique<Actuator>();
  plant->parameters.mass_kg = 10.0;
  plant->parameters.damping_N_s_per_m = 300.0;
  plant->parameters.supply_pressure_Pa = 1.379e7;
  plant->prepare(1e-4);
  plant->reset();
  const Difference fine = open_loop(reference("stiff"), *plant, 1e-4);
  EXPECT_LT(fine.y_m, 1e-9);
  EXPECT_LT(fine.pressure, 1e-5);
}

/// Effects as reference.py names them in OIL and LOAD.
using Values = std::vector<std::array<std::string, 2>>;

Difference with_effects(const std::string& name, const Values& names,
                        const std::vector<double>& values) {
  Actuator plant;
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_TRUE(set_effect(plant, names[i][0], names[i][1], values[i])) << names[i][1];
  }
  plant.prepare(2.5e-5);
  plant.reset();
  return open_loop(reference(name), plant, 2.5e-5);
}

TEST(EffectsOnOil, FollowSciPyTogether) {
  const Difference fine = with_effects("oil",
                                       {{"flow_asymmetry", "asymmetry_ratio"},
                                        {"supply_droop", "droop_Pa_per_m3ps"},
                                        {"internal_leakage", "conductance_m3ps_per_Pa"},
                                        {"external_leakage", "conductance_m3ps_per_Pa"},
                                        {"entrained_air", "fraction_ratio"}},
                                       {0.08, 2e10, 3e-12, 1e-12, 0.01});
  EXPECT_LT(fine.y_m, 1e-9);
  EXPECT_LT(fine.speed, 1e-6);
  EXPECT_LT(fine.pressure, 1e-6);
}

TEST(EffectsOnTheRod, FollowSciPyTogether) {
  const Difference fine = with_effects("load",
                                       {{"quadratic_damping", "coefficient_N_s2_per_m2"},
                                        {"load_spring", "stiffness_N_per_m"},
                                        {"load_spring", "rest_m"},
                                        {"load_force", "force_N"},
                                        {"force_ripple", "amplitude_N"},
                                        {"force_ripple", "wavelength_m"},
                                        {"force_ripple", "phase_rad"}},
                                       {2e4, 2e4, 0.3, 300.0, 100.0, 0.01, 1.0});
  EXPECT_LT(fine.y_m, 1e-9);
  EXPECT_LT(fine.speed, 1e-6);
  EXPECT_LT(fine.pressure, 1e-6);
}

TEST(HydraulicActuator, FollowsSciPyInClosedLoopAtOneMillisecond) {
  auto plant = at_rest();
  const std::vector<Row> rows = reference("loop");
  ASSERT_EQ(rows.size(), 40U);
  Difference worst;
  for (int k = 0; k < 800; ++k) {
    const double u_V = 100.0 * (0.0254 * std::sin(M_PI * k * 0.005) + 0.305 - plant->state.y_m);
    if (k % 20 == 0) worst.take(plant->state, rows[static_cast<std::size_t>(k / 20)]);
    hold(*plant, u_V, 0.005);
  }
  EXPECT_LT(worst.y_m, 2e-8);
  EXPECT_LT(worst.pressure, 1e-4);
}

}  // namespace
}  // namespace plant_sim::testing
