// Finite in, finite out: whatever the parameters, the state, the voltage.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

/// Anywhere in the range, evenly by magnitude, its ends included.
double anywhere(const ParameterInfo& info, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double pick = unit(random);
  if (pick < 0.05) return info.min;
  if (pick < 0.10) return info.max;
  const double top = std::min(info.max, 1e300);
  if (info.min < 0.0) return info.min + (top - info.min) * unit(random);
  const double low = std::max(info.min, 1e-9 * top);
  return low * std::pow(top / low, unit(random));
}

double any_voltage(std::mt19937& random) {
  std::uniform_int_distribution<int> kind(0, 9);
  std::normal_distribution<double> normal;
  switch (kind(random)) {
    case 0:
      return 1.7e308;
    case 1:
      return -1.7e308;
    case 2:
      return std::numeric_limits<double>::quiet_NaN();
    case 3:
      return -std::numeric_limits<double>::infinity();
    case 4:
      return 5e-324;
    default:
      return 10.0 * normal(random);
  }
}

template <class Plant>
void expect_physical(const Plant& plant, const std::string& where) {
  auto state = plant.state;
  state.visit([&](const char* name, double& value) {
    ASSERT_TRUE(std::isfinite(value)) << where << " " << name;
  });
  ASSERT_TRUE(std::isfinite(plant.effects.reading_m(state.y_m))) << where;
  ASSERT_TRUE(std::isfinite(plant.speed_mps())) << where;
}

void expect_physical(const Actuator& plant, const std::string& where) {
  expect_physical<Actuator>(plant, where);
  const Actuator::State& x = plant.state;
  ASSERT_GE(x.y_m, 0.0) << where;
  ASSERT_LE(x.y_m, plant.parameters.stroke_m) << where;
  ASSERT_GE(std::min(x.in_Pa, x.out_Pa), 0.0) << where;
}

template <class Plant>
class EveryPlant : public ::testing::Test {};
using Plants = ::testing::Types<Actuator, Servo, Axis>;
TYPED_TEST_SUITE(EveryPlant, Plants);

TYPED_TEST(EveryPlant, StaysFiniteForAnyParametersAnyEffectsAndAnyVoltage) {
  std::mt19937 random(1);
  for (int run = 0; run < 400; ++run) {
    TypeParam plant;
    const int only = run % 5 < 2 ? -1 : run % 19;  // all effects together, or one
    plant.parameters.visit([&](const ParameterInfo& info, double& value) {
      if (run % 2 == 0) value = anywhere(info, random);
    });
    int index = 0;
    plant.effects.each([&](auto, auto& parameters) {
      const bool chosen = only < 0 || only == index;
      ++index;
      parameters.visit([&](const ParameterInfo& info, double& value) {
        if (run % 3 != 0 && chosen) value = anywhere(info, random);
      });
    });
    plant.prepare(1e-3);
    plant.reset();
    for (int k = 0; k < 60; ++k) {
      const double u_V = any_voltage(random);
      for (int i = 0; i < 5; ++i) {
        plant.step(u_V);
        expect_physical(plant, "run " + std::to_string(run) + " step " + std::to_string(k));
        if (this->HasFatalFailure()) return;
      }
    }
  }
}

TEST(HydraulicActuator, TakesParametersThatAreNoNumbersAsTheLeastAllowed) {
  auto plant = at_rest();
  plant->parameters.bulk_modulus_Pa = std::numeric_limits<double>::quiet_NaN();
  plant->parameters.mass_kg = -5.0;
  plant->parameters.stroke_m = std::numeric_limits<double>::infinity();
  hold(*plant, 3.0, 0.5);
  expect_physical(*plant, "no numbers");
  EXPECT_EQ(plant->parameters.mass_kg, 0.1);
}

TEST(HydraulicActuator, SurvivesFullStrokesIntoBothStops) {
  auto plant = at_rest();
  for (int k = 0; k < 40; ++k) {
    hold(*plant, k % 2 == 0 ? 10.0 : -10.0, 3.0);
    expect_physical(*plant, std::to_string(k));
  }
  EXPECT_EQ(plant->state.y_m, 0.0);
}

}  // namespace
}  // namespace plant_sim::testing
