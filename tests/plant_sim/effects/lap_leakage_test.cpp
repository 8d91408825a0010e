// Leakage of the spool's laps against edges written out, each with its own opening and drop.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

constexpr double kNull_V = 0.05;
constexpr double kFade_V = 0.25;

std::unique_ptr<Actuator> leaking() {
  auto plant = at_rest();
  set_effect(*plant, "lap_leakage", "opening_V", kNull_V);
  set_effect(*plant, "lap_leakage", "fade_V", kFade_V);
  plant->prepare(1e-3);
  return plant;
}

TEST(LapLeakage, OpensEveryEdgeAndFadesUnderItsOverlap) {
  auto plant = leaking();
  const Actuator::Parameters& p = plant->parameters;
  const double supply_Pa = p.supply_pressure_Pa;
  const double in_Pa = 0.6 * supply_Pa;
  const double out_Pa = 0.3 * supply_Pa;
  const double c_m3ps_per_V = p.discharge_coefficient * p.area_gradient_m *
                              std::sqrt(2.0 / p.density_kg_per_m3) * p.valve_gain_m_per_V;
  // opened by so many volts, and what is left of the leakage under as much overlap
  const std::vector<std::pair<double, double>> points{{0.0, 1.0}, {0.25, 0.5}, {0.75, 0.25}};
  for (const auto& [open_V, left] : points) {
    Actuator::State x = plant->state;
    x.spool_m = open_V * p.valve_gain_m_per_V;
    x.in_Pa = in_Pa;
    x.out_Pa = out_Pa;
    const Actuator::State rate = plant->rate<false, true>(x, 0.0, x.y_m);
    const double opens = c_m3ps_per_V * (open_V + kNull_V);
    const double shuts = c_m3ps_per_V * kNull_V * left;
    const double in_m3ps = opens * std::sqrt(supply_Pa - in_Pa) - shuts * std::sqrt(in_Pa);
    const double out_m3ps = opens * std::sqrt(out_Pa) - shuts * std::sqrt(supply_Pa - out_Pa);
    const double in_m3 = p.dead_volume_m3 + p.area_m2 * x.y_m;
    const double out_m3 = p.dead_volume_m3 + p.area_m2 * (p.stroke_m - x.y_m);
    EXPECT_NEAR(rate.in_Pa * in_m3 / p.bulk_modulus_Pa, in_m3ps, 1e-16) << open_V;
    EXPECT_NEAR(-rate.out_Pa * out_m3 / p.bulk_modulus_Pa, out_m3ps, 1e-16) << open_V;
  }
}

TEST(LapLeakage, WithoutAFadeAllEdgesLeakEverywhere) {
  effects::LapLeakage<double>::Parameters p;
  p.opening_V = kNull_V;
  for (const double covered_m : {0.0, 0.1, 10.0}) {
    EXPECT_EQ(effects::LapLeakage<double>::edge_m(p, -covered_m, 2.0), 2.0 * kNull_V);
  }
  EXPECT_EQ(effects::LapLeakage<double>::edge_m(p, 0.25, 2.0), 0.25 + 2.0 * kNull_V);
}

// At null, as an underlap of the same opening: Merritt (1967), section 5-4.
TEST(LapLeakage, LetsALoadMoveTheRodAtNullAsAnUnderlapDoes) {
  auto plant = leaking();
  auto underlapped = at_rest();
  set_effect(*underlapped, "underlap", "half_width_V", kNull_V);
  for (Actuator* one : {plant.get(), underlapped.get()}) {
    set_effect(*one, "load_force", "force_N", 1500.0);
    hold(*one, 0.0, 2.0);
  }
  EXPECT_LT(plant->state.v_mps, -1e-4);
  EXPECT_NEAR(plant->state.v_mps, underlapped->state.v_mps, 1e-12);
}

// Both in one valve: edges are ahead by the underlap, and leak beyond it.
TEST(LapLeakage, ActsBehindAnUnderlap) {
  auto plant = leaking();
  set_effect(*plant, "underlap", "half_width_V", 0.1);
  plant->prepare(1e-3);
  const double gain = plant->parameters.valve_gain_m_per_V;
  const double ahead_m = plant->effects.underlap_m(gain) - 0.35 * gain;
  EXPECT_NEAR(plant->effects.edge_m(ahead_m, gain), 0.5 * kNull_V * gain, 1e-18);
}

}  // namespace
}  // namespace plant_sim::testing
