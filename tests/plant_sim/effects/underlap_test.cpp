// The underlapped spool against the closed forms of Merritt (1967), section 5-4, symbols as there.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kHalfWidth_V = 0.2;
constexpr double kSettled_s = 4.0;   // the slowest mode, the mean pressure, ends by then
constexpr double kUnsettled = 1e-6;  // a speed's change after that time

std::unique_ptr<Actuator> underlapped(double half_width_V = kHalfWidth_V) {
  auto plant = at_rest();
  set_effect(*plant, "underlap", "half_width_V", half_width_V);
  plant->prepare(1e-3);
  return plant;
}

double lap_m(const Actuator& plant) { return kHalfWidth_V * plant.parameters.valve_gain_m_per_V; }

/// Load flow of the open-centre valve at the load pressure, inside the zone and outside.
double load_flow_m3ps(const Actuator::Parameters& p, double x_m, double u_m, double load_Pa) {
  const double c = p.discharge_coefficient * p.area_gradient_m / std::sqrt(p.density_kg_per_m3);
  const double ps = p.supply_pressure_Pa;
  if (x_m > u_m) return c * (u_m + x_m) * std::sqrt(ps - load_Pa);
  if (x_m < -u_m) return -c * (u_m - x_m) * std::sqrt(ps + load_Pa);
  return c * ((u_m + x_m) * std::sqrt(ps - load_Pa) - (u_m - x_m) * std::sqrt(ps + load_Pa));
}

TEST(Underlap, PassesTheOpenCentreValvesLoadFlow) {
  auto plant = underlapped();
  const Actuator::Parameters& p = plant->parameters;
  const double u_m = lap_m(*plant);
  for (const double part : {-3.0, -1.01, -0.6, 0.0, 0.3, 0.99, 1.4, 5.0}) {
    for (const double load_Pa : {-4e6, -1e5, 0.0, 2e6, 5e6}) {
      Actuator::State x = plant->state;
      x.spool_m = part * u_m;
      x.in_Pa = 0.5 * (p.supply_pressure_Pa + load_Pa);
      x.out_Pa = 0.5 * (p.supply_pressure_Pa - load_Pa);
      const Actuator::State rate = plant->rate<false, true>(x, 0.0, x.y_m);
      const double beta = p.bulk_modulus_Pa;
      const double in_m3 = p.dead_volume_m3 + p.area_m2 * x.y_m;
      const double out_m3 = p.dead_volume_m3 + p.area_m2 * (p.stroke_m - x.y_m);
      const double expected = load_flow_m3ps(p, x.spool_m, u_m, load_Pa);
      EXPECT_NEAR(rate.in_Pa * in_m3 / beta, expected, 1e-17) << part << " " << load_Pa;
      EXPECT_NEAR(-rate.out_Pa * out_m3 / beta, expected, 1e-17) << part << " " << load_Pa;
    }
  }
}

TEST(Underlap, HasTwiceTheFlowGainWithinTheZone) {
  auto plant = underlapped();
  plant->parameters.damping_N_s_per_m = 0.0;
  hold(*plant, 0.5 * kHalfWidth_V, kSettled_s);
  const double from_m = plant->state.y_m;
  hold(*plant, 0.5 * kHalfWidth_V, 1.0);
  const double critical_mps = steady_speed_mps(plant->parameters, 0.5 * lap_m(*plant));
  EXPECT_NEAR(plant->state.y_m - from_m, 2.0 * critical_mps, kUnsettled * critical_mps);
}

TEST(Underlap, LetsALoadMoveTheRodAtNullAndTheCriticalCentreDoesNot) {
  constexpr double kLoad_N = 1500.0;
  auto plant = underlapped();
  auto critical = at_rest();
  for (Actuator* one : {plant.get(), critical.get()}) {
    set_effect(*one, "load_force", "force_N", kLoad_N);
    hold(*one, 0.0, kSettled_s);
  }
  const double from_m = plant->state.y_m;
  const double shut_m = critical->state.y_m;
  hold(*plant, 0.0, 1.0);
  hold(*critical, 0.0, 1.0);
  const Actuator::Parameters& p = plant->parameters;
  double speed_mps = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double load_Pa = (kLoad_N + p.damping_N_s_per_m * speed_mps) / p.area_m2;
    speed_mps = load_flow_m3ps(p, 0.0, lap_m(*plant), load_Pa) / p.area_m2;
  }
  EXPECT_LT(speed_mps, -1e-3);
  EXPECT_NEAR(plant->state.y_m - from_m, speed_mps, kUnsettled * std::abs(speed_mps));
  EXPECT_NEAR(critical->state.y_m, shut_m, 1e-9);
}

// Merritt's null leakage Qc = 2 Cd w U sqrt(Ps/rho), drawn through a resistance D of the supply:
// both ports' edges pass Q/2 at the drop (Ps - D Q)/2.
TEST(Underlap, DrawsItsLeakageFromTheSupplyAtNull) {
  constexpr double kDroop = 1e10;
  auto plant = underlapped();
  set_effect(*plant, "supply_droop", "droop_Pa_per_m3ps", kDroop);
  hold(*plant, 0.0, 3.0);
  const Actuator::Parameters& p = plant->parameters;
  const double c = 2.0 * p.discharge_coefficient * p.area_gradient_m * lap_m(*plant) /
                   std::sqrt(p.density_kg_per_m3);
  const double c2d = c * c * kDroop;
  const double flow_m3ps = 0.5 * (-c2d + std::sqrt(c2d * c2d + 4.0 * c * c * p.supply_pressure_Pa));
  EXPECT_NEAR(plant->pressures().supply_Pa, p.supply_pressure_Pa - kDroop * flow_m3ps, 1.0);
  EXPECT_GT(kDroop * flow_m3ps, 1e5);
}

TEST(Underlap, OpensTheFreeEdgesOfAnUnequalValveByItsRatio) {
  HydraulicCylinder<double> plant;
  plant.parameters.valve_area_ratio = 0.6;
  set_effect(plant, "underlap", "half_width_V", kHalfWidth_V);
  plant.prepare(1e-4);
  plant.reset();
  const auto& p = plant.parameters;
  auto x = plant.state;
  x.in_Pa = 5e6;
  x.out_Pa = 9e6;
  const auto rate = plant.rate<false, true>(x, 0.0, x.y_m);
  const double g =
      p.rated_flow_m3ps * kHalfWidth_V / p.rated_command_V / std::sqrt(p.rated_drop_Pa);
  const double in_m3ps =
      g * (std::sqrt(p.supply_pressure_Pa - 5e6) - std::sqrt(5e6 - p.return_pressure_Pa));
  const double out_m3ps =
      0.6 * g * (std::sqrt(9e6 - p.return_pressure_Pa) - std::sqrt(p.supply_pressure_Pa - 9e6));
  const double in_m3 = p.cap_dead_volume_m3 + p.cap_area_m2 * x.y_m;
  const double out_m3 = p.rod_dead_volume_m3 + p.rod_side_area_m2 * (p.stroke_m - x.y_m);
  EXPECT_NEAR(rate.in_Pa * in_m3 / p.bulk_modulus_Pa, in_m3ps, 1e-12 * std::abs(in_m3ps));
  EXPECT_NEAR(-rate.out_Pa * out_m3 / p.bulk_modulus_Pa, out_m3ps, 1e-12 * std::abs(out_m3ps));
}

TEST(Underlap, IsTheNetOpeningOfAServoWithoutPressures) {
  for (const double u_V : {-1.0, -0.2, -0.05, 0.1, 0.4}) {
    auto plant = at_rest<Servo>();
    set_effect(*plant, "underlap", "half_width_V", kHalfWidth_V);
    hold(*plant, u_V, 1.0);
    const double net_V =
        std::abs(u_V) < kHalfWidth_V ? 2.0 * u_V : u_V + std::copysign(kHalfWidth_V, u_V);
    EXPECT_NEAR(plant->state.y_m, 0.05 * net_V, 1e-14) << u_V;
    EXPECT_NEAR(plant->speed_mps(), 0.05 * net_V, 1e-16);
  }
}

TEST(Underlap, NeedsNoFinerStepThanTheValveWithoutIt) {
  const auto end_m = [](double step_s) {
    auto plant = underlapped(1.0);
    plant->prepare(step_s);
    for (long k = 0; k < std::lround(3.0 / step_s); ++k) {
      plant->step(2.0 * std::sin(4.0 * static_cast<double>(k) * step_s));
    }
    return plant->state.y_m;
  };
  EXPECT_NEAR(end_m(1e-3), end_m(1e-4), 1e-4);
}

}  // namespace
}  // namespace plant_sim::testing
