// The readings of pressure transducers on a plant.
#include <gtest/gtest.h>

#include <cmath>

#include "plant_sim/plant.h"
#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

TEST(Pressures, AreThoseOfTheChambersAndOfTheSupply) {
  const auto plant = make_plant(ModelFile());
  plant->advance(1.0, 3.0);
  const config::signals::Pressures found = plant->pressures();
  // steady speed, equal drops over both orifices: in + out = supply, in - out = d v / A
  EXPECT_EQ(found.supply_Pa, 6.89e6);
  EXPECT_NEAR(found.in_Pa + found.out_Pa, 6.89e6, 1e3);
  EXPECT_NEAR(found.in_Pa - found.out_Pa, 1000.0 * plant->speed_mps() / 6.33e-4, 1e3);
}

TEST(Pressures, HaveTheSupplyAsItIsNowAndAsTheFlowLeavesIt) {
  const auto plant = make_plant(ModelFile());
  *plant->parameter("supply_pressure_Pa") = 6e6;
  EXPECT_EQ(plant->pressures().supply_Pa, 6e6);
  constexpr double kDroop_Pa_per_m3ps = 3e10;
  *plant->parameter("supply_droop.droop_Pa_per_m3ps") = kDroop_Pa_per_m3ps;
  plant->advance(2.0, 1.5);
  // at a steady speed the valve draws A v
  const double left_Pa = 6e6 - kDroop_Pa_per_m3ps * 6.33e-4 * plant->speed_mps();
  EXPECT_NEAR(plant->pressures().supply_Pa, left_Pa, 1e-3 * 6e6);
  EXPECT_LT(left_Pa, 5.5e6);
}

TEST(Pressures, AreNoNumbersWhereAPlantHasNone) {
  for (const char* name : {"velocity_servo", "force_driven_axis"}) {
    ModelFile model;
    model.plant = name;
    model.parameters.clear();
    model.initial.clear();
    const config::signals::Pressures found = make_plant(model)->pressures();
    EXPECT_TRUE(std::isnan(found.supply_Pa)) << name;
    EXPECT_TRUE(std::isnan(found.in_Pa)) << name;
    EXPECT_TRUE(std::isnan(found.out_Pa)) << name;
  }
}

}  // namespace
}  // namespace plant_sim::testing
