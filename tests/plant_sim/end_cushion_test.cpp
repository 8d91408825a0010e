// The end cushions against closed forms: the pressure of a throttled outlet, and a stop by it.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kLength_m = 0.05;
constexpr double kOrifice_m2 = 4e-7;

std::unique_ptr<Actuator> cushioned(double from_m) {
  auto plant = std::make_unique<Actuator>();
  plant->parameters.retracted_cushion_length_m = kLength_m;
  plant->parameters.retracted_cushion_orifice_m2 = kOrifice_m2;
  plant->parameters.extended_cushion_length_m = kLength_m;
  plant->parameters.extended_cushion_orifice_m2 = kOrifice_m2;
  plant->initial.y_m = from_m;
  plant->prepare(1e-4);
  plant->reset();
  return plant;
}

double conductance(const Actuator::Parameters& p, double area_m2) {
  return p.discharge_coefficient * area_m2 * std::sqrt(2.0 / p.density_kg_per_m3);
}

// At a steady speed v: A v = Gv sqrt(Ps - P1) at the inlet, and at the outlet, where valve and
// throttle share the drop, P2 - Pe = (A v)^2 (1/Gv^2 + 1/Gc^2). The force balance is A (P1 - P2) =
// d v, so that Ps - Pe = d v/A + (A v)^2 (2/Gv^2 + 1/Gc^2).
double cushioned_speed_mps(const Actuator::Parameters& p, double u_V) {
  const double gv = conductance(p, p.area_gradient_m * p.valve_gain_m_per_V * u_V);
  const double gc = conductance(p, kOrifice_m2);
  const double a2 = p.area_m2 * p.area_m2 * (2.0 / (gv * gv) + 1.0 / (gc * gc));
  const double a1 = p.damping_N_s_per_m / p.area_m2;
  const double a0 = -(p.supply_pressure_Pa - p.return_pressure_Pa);
  return (-a1 + std::sqrt(a1 * a1 - 4.0 * a2 * a0)) / (2.0 * a2);
}

TEST(EndCushion, SlowsTheRodToTheSpeedOfValveAndThrottleInSeries) {
  constexpr double kCommand_V = 4.0;
  constexpr double kSteady = 1e-3;  // the chambers' volumes change on the way
  for (const double sign : {1.0, -1.0}) {
    auto plant = cushioned(0.305 + sign * 0.2);
    const Actuator::Parameters& p = plant->parameters;
    const double edge_m = sign > 0.0 ? p.stroke_m - kLength_m : kLength_m;
    double before_mps = 0.0;
    while (sign * (plant->state.y_m - edge_m) < 0.0) {
      before_mps = sign * plant->state.v_mps;
      plant->step(sign * kCommand_V);
    }
    const double free_mps = steady_speed_mps(p, kCommand_V * p.valve_gain_m_per_V);
    EXPECT_NEAR(before_mps, free_mps, 0.05 * free_mps);
    while (sign * (plant->state.y_m - edge_m) < 0.9 * kLength_m) plant->step(sign * kCommand_V);
    const double slow_mps = cushioned_speed_mps(p, kCommand_V);
    EXPECT_LT(slow_mps, 0.5 * free_mps);
    EXPECT_NEAR(sign * plant->state.v_mps, slow_mps, kSteady * slow_mps);
    const double flow = p.area_m2 * slow_mps;
    const double gv = conductance(p, p.area_gradient_m * p.valve_gain_m_per_V * kCommand_V);
    const double gc = conductance(p, kOrifice_m2);
    const double shut_Pa = flow * flow * (1.0 / (gv * gv) + 1.0 / (gc * gc));
    EXPECT_NEAR(sign > 0.0 ? plant->state.out_Pa : plant->state.in_Pa, shut_Pa, 4e-3 * shut_Pa);
  }
}

TEST(EndCushion, LetsTheRodLeaveItsStopAtOnce) {
  auto with = cushioned(0.005);
  auto without = std::make_unique<Actuator>();
  without->initial.y_m = 0.005;
  without->prepare(1e-4);
  without->reset();
  for (Actuator* one : {with.get(), without.get()}) hold(*one, 2.0, 0.6, 1e-4);
  EXPECT_NEAR(with->state.y_m, without->state.y_m, 1e-6);
  EXPECT_GT(with->state.y_m, 0.05);
}

// With both orifices of the valve wide open and heavy mass the throttle alone stops it: no inflow
// matters, m v dv/dy = -A (A v/Gc)^2 gives v = v0 exp(-A^3 s/(m Gc^2)) over the way s.
TEST(EndCushion, TakesTheSpeedOfAHeavyMassExponentiallyOverTheWay) {
  constexpr double kStart_mps = 0.5;
  auto plant = cushioned(0.55);
  Actuator::Parameters& p = plant->parameters;
  p.extended_cushion_length_m = 0.3;
  p.extended_cushion_orifice_m2 = 4e-6;
  p.mass_kg = 3000.0;
  p.damping_N_s_per_m = 0.0;
  p.supply_pressure_Pa = 0.0;
  p.bulk_modulus_Pa = 1e11;
  p.valve_gain_m_per_V = 1e-3;
  plant->initial.y_m = 0.4;
  plant->initial.v_mps = kStart_mps;
  plant->initial.spool_m = 1e-2;
  plant->prepare(1e-5);
  plant->reset();
  const double gc = conductance(p, 4e-6);
  const double way_m = p.mass_kg * gc * gc / std::pow(p.area_m2, 3);
  while (plant->state.y_m < 0.5) plant->step(10.0);
  const double expected = kStart_mps * std::exp(-(plant->state.y_m - 0.4) / way_m);
  EXPECT_LT(expected, 0.9 * kStart_mps);
  EXPECT_NEAR(plant->state.v_mps, expected, 2e-3 * kStart_mps);
}

TEST(EndCushion, ChangesNotOneBitOutsideItsZoneNorWithoutALength) {
  const auto run = [](double length_m, double orifice_m2) {
    Actuator plant;
    plant.parameters.retracted_cushion_length_m = length_m;
    plant.parameters.extended_cushion_length_m = length_m;
    plant.parameters.retracted_cushion_orifice_m2 = orifice_m2;
    plant.prepare(1e-3);
    plant.reset();
    for (int k = 0; k < 3000; ++k) plant.step(2.0 * std::sin(0.02 * k));
    return plant.state;
  };
  const Actuator::State plain = run(0.0, 1e-6);
  for (const Actuator::State& other : {run(0.0, 0.0), run(0.05, 1e-7)}) {
    EXPECT_EQ(other.y_m, plain.y_m);
    EXPECT_EQ(other.v_mps, plain.v_mps);
    EXPECT_EQ(other.in_Pa, plain.in_Pa);
    EXPECT_EQ(other.out_Pa, plain.out_Pa);
  }
}

}  // namespace
}  // namespace plant_sim::testing
