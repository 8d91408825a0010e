#include "estimator/greybox/free_parameter.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace estimator::greybox {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(FreeParameter, GoesThereAndBackOnEveryScale) {
  for (const ParameterScale scale : {ParameterScale::linear, ParameterScale::logarithmic,
                                     ParameterScale::reciprocal, ParameterScale::square}) {
    const FreeParameter p{"x", scale, 40.0};
    for (const double s : {0.2, 1.0, 1.7}) EXPECT_NEAR(p.to_theta(p.to_physical(s)), s, 1e-12);
  }
}

TEST(FreeParameter, StandsForTheNeutralValueAtZero) {
  EXPECT_EQ((FreeParameter{"x", ParameterScale::linear, 40.0}).to_physical(0.0), 0.0);
  EXPECT_EQ((FreeParameter{"x", ParameterScale::logarithmic, 40.0}).to_physical(0.0), 40.0);
  EXPECT_EQ((FreeParameter{"x", ParameterScale::reciprocal, 40.0}).to_physical(0.0), kInfinite);
  EXPECT_EQ((FreeParameter{"x", ParameterScale::square, 40.0}).to_physical(0.0), 0.0);
}

TEST(FreeParameter, HasTheSlopeOfItsValue) {
  for (const ParameterScale scale : {ParameterScale::linear, ParameterScale::logarithmic,
                                     ParameterScale::reciprocal, ParameterScale::square}) {
    const FreeParameter p{"x", scale, 40.0};
    const double h = 1e-6;
    const double difference = std::abs(p.to_physical(0.7 + h) - p.to_physical(0.7 - h)) / (2.0 * h);
    EXPECT_NEAR(p.slope(0.7), difference, 1e-5 * difference);
  }
}

TEST(EffectParameters, OfASquareReachAsFarFromTheirTypicalSizeAsOthers) {
  const auto found = effect_parameters(*plant_sim::find_effect("deadband"), 1);
  const auto upper = [&](const std::string& name) {
    const auto p = std::find_if(found.begin(), found.end(),
                                [&](const FreeParameter& one) { return one.name == name; });
    return p == found.end() ? 0.0 : p->to_physical(p->upper) / p->unit;
  };
  EXPECT_NEAR(upper("deadband.corner_V"), upper("deadband.half_width_V"), 1e-9);
}

TEST(PlantParameters, CentreOnTheModelFileWithinItsRanges) {
  plant_sim::ModelFile model;
  *model.value("damping_N_s_per_m") = 1234.0;
  const std::vector<FreeParameter> found = plant_parameters(model);
  ASSERT_FALSE(found.empty());
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(model.plant);
  bool damping = false;
  for (const FreeParameter& p : found) {
    EXPECT_DOUBLE_EQ(p.to_physical(0.0), *model.value(p.name)) << p.name;
    EXPECT_LT(p.lower, 0.0) << p.name;
    EXPECT_GT(p.upper, 0.0) << p.name;
    for (const plant_sim::ParameterInfo& info : plant.parameters) {
      if (p.name != info.name) continue;
      EXPECT_GE(p.to_physical(p.lower), info.min * (1.0 - 1e-9)) << p.name;
      EXPECT_LE(p.to_physical(p.upper), info.max * (1.0 + 1e-9)) << p.name;
      EXPECT_GT(info.uncertainty_ratio, 0.0) << p.name;
    }
    damping = damping || p.name == "damping_N_s_per_m";
  }
  EXPECT_TRUE(damping);
}

TEST(EffectParameters, ReachTheirNeutralValueForEveryEffectOfTheLibrary) {
  for (const plant_sim::EffectInfo& effect : plant_sim::effect_library()) {
    for (const FreeParameter& p : effect_parameters(effect, kEveryRefinement)) {
      for (const plant_sim::ParameterInfo& info : effect.parameters) {
        if (p.name != effect.name + "." + info.name) continue;
        EXPECT_LT(p.lower, p.upper) << p.name;
        if (std::isinf(info.neutral)) {
          EXPECT_EQ(p.to_physical(p.lower), kInfinite) << p.name;
        }
        EXPECT_GE(p.to_physical(p.upper), info.min) << p.name;
        EXPECT_LE(std::min(p.to_physical(p.lower), p.to_physical(p.upper)), info.max) << p.name;
      }
    }
  }
}

}  // namespace
}  // namespace estimator::greybox
