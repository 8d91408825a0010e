#include "plant_sim/instruments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plant_sim {
namespace {

TEST(Encoder, RoundsToItsResolution) {
  Encoder encoder(5e-6, 0.0, 1);
  EXPECT_DOUBLE_EQ(encoder.read(0.3050024), 0.305);
  EXPECT_DOUBLE_EQ(encoder.read(0.3050026), 0.305005);
  EXPECT_DOUBLE_EQ(encoder.read(-0.0000026), -5e-6);
}

TEST(Encoder, WithoutResolutionAndNoiseReadsTheTruth) {
  Encoder encoder(0.0, 0.0, 1);
  EXPECT_EQ(encoder.read(0.123456789012345), 0.123456789012345);
}

TEST(Encoder, ErrorOfAFineRampIsUniformOverOneStep) {
  Encoder encoder(4e-6, 0.0, 1);
  double sum2 = 0.0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double y_m = 0.1 + 1e-9 * i;
    sum2 += std::pow(encoder.read(y_m) - y_m, 2);
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 4e-6 / std::sqrt(12.0), 1e-9);
}

TEST(Encoder, NoiseHasTheMomentsOfANormalDistribution) {
  Encoder encoder(0.0, 2e-6, 42);
  const int n = 200000;
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = encoder.read(0.0) / 2e-6;
    sum += z;
    sum2 += z * z;
    sum4 += z * z * z * z;
  }
  // five standard errors: of the mean 1, of the variance sqrt 2, of the fourth moment sqrt 96
  const double root_n = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(sum / n, 0.0, 5.0 / root_n);
  EXPECT_NEAR(sum2 / n, 1.0, 5.0 * std::sqrt(2.0) / root_n);
  EXPECT_NEAR(sum4 / n, 3.0, 5.0 * std::sqrt(96.0) / root_n);
}

TEST(Encoder, TheSeedDecidesTheNoise) {
  Encoder a(0.0, 1e-6, 5);
  Encoder b(0.0, 1e-6, 5);
  Encoder c(0.0, 1e-6, 6);
  bool differs = false;
  for (int i = 0; i < 10; ++i) {
    const double first = a.read(0.0);
    EXPECT_EQ(first, b.read(0.0));
    differs = differs || first != c.read(0.0);
  }
  EXPECT_TRUE(differs);
}

TEST(DacRange, HasTheCodesOfTwelveBitsOverTenVolts) {
  const DacRange dac{12, 10.0};
  EXPECT_DOUBLE_EQ(dac.step_V(), 20.0 / 4096.0);
  EXPECT_DOUBLE_EQ(dac.apply(0.0), 0.0);
  EXPECT_DOUBLE_EQ(dac.apply(0.0025), 20.0 / 4096.0);
  EXPECT_DOUBLE_EQ(dac.apply(0.0024), 0.0);
  EXPECT_DOUBLE_EQ(dac.apply(12.0), 10.0 - 20.0 / 4096.0);
  EXPECT_DOUBLE_EQ(dac.apply(-12.0), -10.0);
}

TEST(DacRange, PutsOutNothingForNoNumberAndItsEndForInfinity) {
  const DacRange dac{12, 10.0};
  EXPECT_EQ(dac.apply(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_DOUBLE_EQ(dac.apply(-std::numeric_limits<double>::infinity()), -10.0);
}

TEST(DacRange, WithoutBitsOnlyLimits) {
  const DacRange dac{0, 10.0};
  EXPECT_EQ(dac.apply(1.23456789), 1.23456789);
  EXPECT_EQ(dac.apply(11.0), 10.0);
}

}  // namespace
}  // namespace plant_sim
