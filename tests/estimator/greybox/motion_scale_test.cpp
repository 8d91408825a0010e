#include "estimator/greybox/motion_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace estimator::greybox {
namespace {

constexpr double kTs = 0.005;
constexpr double kObserver = 2.0;

/// A record of `factor` times the model's motion, and some `other` motion.
MotionRatio ratio(double factor, double other, PlantStart start = PlantStart::held_by_oil) {
  std::vector<double> u;
  std::vector<double> y;
  std::vector<double> modelled;
  for (int k = 0; k < 4000; ++k) {
    const double t_s = kTs * k;
    u.push_back(0.0);
    modelled.push_back(std::sin(1.9 * t_s) + 0.4 * std::sin(7.0 * t_s));
    y.push_back(factor * (modelled.back() + other * std::sin(4.1 * t_s)) + 0.1 * t_s);
  }
  const Dataset record = dataset_of(kTs, u, y);
  // The observer pulls the model's position to the measured one.
  std::vector<double> error_m{0.0};
  for (std::size_t k = 0; k + 1 < y.size(); ++k) {
    const double kept = 1.0 - record.observer_gain(k, kObserver, start).position;
    error_m.push_back(kept * error_m[k] + y[k + 1] - y[k] - modelled[k + 1] + modelled[k]);
  }
  return motion_ratio(record, error_m, kObserver, start);
}

TEST(MotionScale, IsTheFactorBetweenTheMotions) {
  for (const double factor : {1000.0, 600.0, 0.001, 1.0, -2.0}) {
    const MotionRatio found = ratio(factor, 0.0);
    EXPECT_NEAR(found.ratio, factor, 1e-6 * std::abs(factor));
    EXPECT_NEAR(found.explained, 1.0, 1e-9);
  }
}

TEST(MotionScale, IsTheFactorForAnAxisThatFindsItsSpeedToo) {
  const MotionRatio found = ratio(1.3, 0.0, PlantStart::any_speed);
  EXPECT_NEAR(found.ratio, 1.3, 1e-6);
  EXPECT_NEAR(found.explained, 1.0, 1e-9);
}

TEST(MotionScale, NamesAFactorOfAThousandAlone) {
  EXPECT_EQ(scale_error(ratio(700.0, 0.0)), ScaleError::thousandfold);
  EXPECT_EQ(scale_error(ratio(0.0015, 0.1)), ScaleError::thousandth);
  EXPECT_EQ(scale_error(ratio(1.3, 0.0)), ScaleError::none);
  EXPECT_EQ(scale_error(ratio(30.0, 0.0)), ScaleError::none);
  EXPECT_EQ(scale_error(ratio(-1000.0, 0.0)), ScaleError::none);
}

TEST(MotionScale, SaysNothingOfAMotionThatDoesNotFollow) {
  EXPECT_EQ(scale_error(ratio(0.001, 5.0)), ScaleError::none);
}

TEST(MotionScale, ComparesPositionsWithTheStroke) {
  EXPECT_EQ(scale_error(100.0, 512.0, 0.61), ScaleError::thousandfold);
  EXPECT_EQ(scale_error(0.1, 0.5, 0.61), ScaleError::none);
  EXPECT_EQ(scale_error(-0.3, 0.9, 0.61), ScaleError::none);
  EXPECT_EQ(scale_error(1e-4, 5e-4, 0.61), ScaleError::thousandth);
  EXPECT_EQ(scale_error(-1e-4, 5e-4, 0.61), ScaleError::none) << "about a zero of its own";
  EXPECT_EQ(scale_error(0.0, 4e4, 0.61), ScaleError::none);
}

}  // namespace
}  // namespace estimator::greybox
