// Slope and stiffness of a force over position and speed, by speed.
#include "plant_sim/formula/max_slope.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plant_sim::formula {
namespace {

constexpr VariableRange kStroke{0.0, 0.5};
constexpr VariableRange kSpeeds{-1e5, 1e5};

TEST(MaxSlope, AStiffnessThatGrowsWithTheSpeedIsThatOfTheSpeedAtHand) {
  MaxSlope<double> found;
  // dF/dy = 400 v, dF/dv = 400 y
  found.include(kStroke, kSpeeds, [](double y, double v) { return 400.0 * y * v; });
  EXPECT_NEAR(found.stiffness_N_per_m(), 400.0 * 1e5, 1e3);
  for (const double v_mps : {-0.3, 0.01, 2.0}) {
    const double own = 400.0 * std::abs(v_mps);
    EXPECT_GE(found.stiffness_N_per_m(v_mps), own) << v_mps;
    EXPECT_LE(found.stiffness_N_per_m(v_mps), 2.001 * own) << v_mps;
  }
  EXPECT_NEAR(found.slope_N_s_per_m(0.1), 200.0, 0.1);
}

TEST(MaxSlope, ASpringIsAsStiffAtAnySpeed) {
  MaxSlope<double> found;
  found.include(kStroke, kSpeeds, [](double y, double) { return 3e4 * y; });
  for (const double v_mps : {0.0, 0.3, -50.0}) {
    EXPECT_NEAR(found.stiffness_N_per_m(v_mps), 3e4, 1.0) << v_mps;
  }
}

}  // namespace
}  // namespace plant_sim::formula
