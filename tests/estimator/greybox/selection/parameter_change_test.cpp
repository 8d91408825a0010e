#include "estimator/greybox/selection/parameter_change.h"

#include <gtest/gtest.h>

#include <limits>

namespace estimator::greybox::selection {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

ParameterChange change(double from, double from_error, double to, double to_error) {
  ParameterChange one;
  one.from = from;
  one.from_error = from_error;
  one.to = to;
  one.to_error = to_error;
  return one;
}

TEST(ParameterChange, IsClearWhereTheValuesAreTwoErrorsApart) {
  EXPECT_TRUE(is_clear_of_errors(change(0.0, 0.1, 234.0, 6.0)));
  EXPECT_TRUE(is_clear_of_errors(change(50.0, kNone, 51.0, 0.4)));
  EXPECT_FALSE(is_clear_of_errors(change(50.0, kNone, 50.7, 0.4)));
  EXPECT_FALSE(is_clear_of_errors(change(0.001, 0.5, 1.0, 0.6)));
  EXPECT_FALSE(is_clear_of_errors(change(100.0, 20.0, 101.0, 10.0)));
  EXPECT_FALSE(is_clear_of_errors(change(68.6, 1.8, 68.3, 2e5)));
  EXPECT_FALSE(is_clear_of_errors(change(68.6, 1.8, 75.0, kUnbounded)));
}

// A gain of which only the scale is uncertain, by 2 %.
TEST(ParameterChange, IsClearOfAScaleThatBothValuesShare) {
  EXPECT_TRUE(is_clear_of_errors(change(50.0, 1.0, 51.0, 1.02)));
  EXPECT_FALSE(is_clear_of_errors(change(50.0, 1.0, 51.0, 1.2)));
}

TEST(ParameterChange, ToABoundIsClearAtZeroAlone) {
  EXPECT_TRUE(is_clear_of_errors(change(120.0, 3.0, 0.0, kNone)));
  EXPECT_FALSE(is_clear_of_errors(change(7762.0, 617.0, 92765.0, kNone)));
}

}  // namespace
}  // namespace estimator::greybox::selection
