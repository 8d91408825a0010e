// exp, log, sin and tanh of the physics against the C library in extended precision.
#include "plant_sim/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "plant_sim/scalar.h"

namespace plant_sim::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In units in the last place of the exact value.
double ulps(double value, long double exact) {
  const double near = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(near, kInfinity) - near;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / unit);
}

/// The largest error of f over random numbers that draw() gives, in ulps; lanes have the same bits.
template <class F, class Exact, class Draw>
double worst(F f, Exact exact, Draw draw) {
  double most = 0.0;
  for (int i = 0; i < 50000; ++i) {
    Simd many;
    for (std::size_t lane = 0; lane < Simd::kSize; ++lane) many.set(lane, draw());
    const Simd result = f(many);
    for (std::size_t lane = 0; lane < Simd::kSize; ++lane) {
      const double one = f(many[lane]);
      EXPECT_EQ(result[lane], one) << many[lane];
      most = std::max(most, ulps(one, exact(static_cast<long double>(many[lane]))));
    }
  }
  return most;
}

const auto kExp = [](const auto& x) { return exp(x); };
const auto kLog = [](const auto& x) { return log(x); };
const auto kSin = [](const auto& x) { return sin(x); };
const auto kTanh = [](const auto& x) { return tanh(x); };

TEST(Exp, IsWithinOneAndAHalfUnitsInTheLastPlace) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> wide(-708.0, 709.7);
  std::uniform_real_distribution<double> narrow(-1.0, 1.0);
  const auto exact = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst(kExp, exact, [&] { return wide(random); }), 1.5);
  EXPECT_LT(worst(kExp, exact, [&] { return narrow(random); }), 1.5);
}

TEST(Exp, EndsInZeroAndInfinity) {
  EXPECT_EQ(exp(0.0), 1.0);
  EXPECT_EQ(exp(-kInfinity), 0.0);
  EXPECT_EQ(exp(-1000.0), 0.0);
  EXPECT_EQ(exp(kInfinity), kInfinity);
  EXPECT_EQ(exp(710.0), kInfinity);
  EXPECT_TRUE(std::isnan(exp(std::nan(""))));
  EXPECT_NEAR(exp(-740.0) / std::exp(-740.0), 1.0, 0.1);  // subnormal
}

TEST(Decay, HasTheBitsOfTheExponentialDownToItsEnd) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> wide(0.0, 700.0);
  std::uniform_real_distribution<double> narrow(0.0, 1.0);
  const auto check = [](double x) {
    EXPECT_EQ(decay(x), exp(-x)) << x;
    EXPECT_EQ(decay(Simd(x))[1], decay(x)) << x;
  };
  for (const double x : {0.0, 1e-300, 700.0}) check(x);
  for (int i = 0; i < 50000; ++i) {
    check(wide(random));
    check(narrow(random));
  }
}

TEST(Log, IsWithinOneAndAHalfUnitsInTheLastPlace) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> near_one(0.5, 2.0);
  std::uniform_real_distribution<double> exponent(-320.0, 308.0);
  const auto exact = [](long double x) { return std::log(x); };
  EXPECT_LT(worst(kLog, exact, [&] { return near_one(random); }), 1.5);
  EXPECT_LT(worst(kLog, exact, [&] { return std::pow(10.0, exponent(random)); }), 1.5);
}

TEST(Log, EndsInInfinitiesAndHasNoValueBelowZero) {
  EXPECT_EQ(log(1.0), 0.0);
  EXPECT_EQ(log(0.0), -kInfinity);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_TRUE(std::isnan(log(std::nan(""))));
}

TEST(Sin, IsWithinThreeUnitsInTheLastPlaceUpToAMillion) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> turn(-4.0, 4.0);
  std::uniform_real_distribution<double> thousand(-1e3, 1e3);
  std::uniform_real_distribution<double> million(-1e6, 1e6);
  const auto exact = [](long double x) { return std::sin(x); };
  EXPECT_LT(worst(kSin, exact, [&] { return turn(random); }), 3.0);
  EXPECT_LT(worst(kSin, exact, [&] { return thousand(random); }), 3.0);
  EXPECT_LT(worst(kSin, exact, [&] { return million(random); }), 3.0);
  // next to the multiples of pi
  EXPECT_LT(worst(kSin, exact, [&] { return M_PI * std::round(thousand(random)); }), 3.0);
}

TEST(Sin, IsTheLibrarysBeyondAndHasNoValueAtInfinity) {
  EXPECT_EQ(sin(0.0), 0.0);
  EXPECT_EQ(sin(1e12), std::sin(1e12));
  EXPECT_TRUE(std::isnan(sin(kInfinity)));
  Simd mixed = 1.0;
  mixed.set(3, 1e12);
  EXPECT_EQ(sin(mixed)[3], std::sin(1e12));
  EXPECT_EQ(sin(mixed)[2], sin(1.0));
}

TEST(Tanh, IsWithinThreeUnitsInTheLastPlace) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> wide(-25.0, 25.0);
  std::uniform_real_distribution<double> narrow(-1.0, 1.0);
  std::uniform_real_distribution<double> exponent(-300.0, 0.0);
  const auto exact = [](long double x) { return std::tanh(x); };
  EXPECT_LT(worst(kTanh, exact, [&] { return wide(random); }), 3.0);
  EXPECT_LT(worst(kTanh, exact, [&] { return narrow(random); }), 3.0);
  EXPECT_LT(worst(kTanh, exact, [&] { return std::pow(10.0, exponent(random)); }), 3.0);
}

TEST(Tanh, EndsInOneAndIsOdd) {
  EXPECT_EQ(tanh(0.0), 0.0);
  for (const double zero : {0.0, -0.0}) {
    EXPECT_EQ(std::signbit(tanh(zero)), std::signbit(zero));
    EXPECT_EQ(std::signbit(tanh(Simd(zero))[1]), std::signbit(zero));
  }
  Simd mixed = 0.5;
  mixed.set(1, std::nan(""));
  mixed.set(2, kInfinity);
  mixed.set(3, -kInfinity);
  EXPECT_EQ(tanh(mixed)[0], tanh(0.5));
  EXPECT_TRUE(std::isnan(tanh(mixed)[1]));
  EXPECT_EQ(tanh(mixed)[2], 1.0);
  EXPECT_EQ(tanh(mixed)[3], -1.0);
  EXPECT_EQ(tanh(kInfinity), 1.0);
  EXPECT_EQ(tanh(-kInfinity), -1.0);
  EXPECT_EQ(tanh(1e300), 1.0);
  EXPECT_EQ(tanh(-0.3), -tanh(0.3));
  EXPECT_TRUE(std::isnan(tanh(std::nan(""))));
  EXPECT_TRUE(std::isnan(tanh(Simd(std::nan("")))[0]));
}

}  // namespace
}  // namespace plant_sim::testing
