#include "hal/comedi/scale.h"

#include <gtest/gtest.h>

namespace hal::comedi {
namespace {

TEST(ConverterSpan, TwelveBitsOverTenVoltsBothWays) {
  const ConverterSpan span{-10.0, 10.0, 4095};
  EXPECT_DOUBLE_EQ(span.volts(0), -10.0);
  EXPECT_DOUBLE_EQ(span.volts(4095), 10.0);
  EXPECT_EQ(span.code(-10.0), 0U);
  EXPECT_EQ(span.code(10.0), 4095U);
  EXPECT_EQ(span.code(0.0), 2048U) << "2047.5 rounds away from zero";
  EXPECT_EQ(span.code(99.0), 4095U);
  EXPECT_EQ(span.code(-99.0), 0U);
  for (std::uint32_t code = 0; code <= 4095; ++code) ASSERT_EQ(span.code(span.volts(code)), code);
  EXPECT_TRUE(span.at_end(0));
  EXPECT_TRUE(span.at_end(4095));
  EXPECT_FALSE(span.at_end(1));
}

TEST(Unwrap, CountsOnThroughTheEndsOfTheCounter) {
  for (const int bits : {8, 16, 24, 32}) {
    Unwrap unwrap(bits);
    const std::uint64_t size = 1ULL << bits;
    std::int64_t truth = 0;
    const auto code = [&] {
      const auto shifted = static_cast<std::uint64_t>(truth + 100);
      return static_cast<std::uint32_t>(shifted % size);
    };
    EXPECT_EQ(unwrap.count(code()), 0) << "counts from the first reading";
    const auto step = static_cast<std::int64_t>(size / 2 - 1);
    for (const std::int64_t move : {step, step, step, -step, -step, -step, -step, 1L, -1L, -101L}) {
      truth += move;
      EXPECT_EQ(unwrap.count(code()), truth) << bits << " bits";
    }
  }
}

TEST(Unwrap, TakesOnlyTheCountersOwnBits) {
  Unwrap unwrap(16);
  unwrap.count(0xAAAA0000U);
  EXPECT_EQ(unwrap.count(0x5555FFFFU), -1);
}

}  // namespace
}  // namespace hal::comedi
