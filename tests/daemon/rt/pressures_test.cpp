// Pressures that the rig measures go with every sample, as they were read in that tick.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using config::signals::Quality;
using hal::InputRole;

std::shared_ptr<FakeInput> add(LoopBench& bench, InputRole role, double value) {
  auto input = std::make_shared<FakeInput>(value);
  bench.inputs.push_back({"input", role, input});
  return input;
}

TEST(Pressures, GoWithTheSampleOfTheirTickByRole) {
  LoopBench bench;
  const auto out = add(bench, InputRole::pressure_out, 2e6);
  const auto other = add(bench, InputRole::pressure, 9e6);
  const auto supply = add(bench, InputRole::supply_pressure, 7e6);
  const auto in = add(bench, InputRole::pressure_in, 4e6);
  for (int n = 0; n < 5; ++n) {
    supply->value += 1e3;
    in->value -= 2e3;
    out->value += 3e3;
    other->value = 1.0;
    const config::signals::Pressures found = bench.sample().pressures;
    EXPECT_EQ(found.supply_Pa, supply->value);
    EXPECT_EQ(found.in_Pa, in->value);
    EXPECT_EQ(found.out_Pa, out->value);
  }
}

TEST(Pressures, AreNoNumberWhereNothingMeasuresThem) {
  LoopBench bench;
  add(bench, InputRole::pressure, 9e6);
  add(bench, InputRole::pressure_in, 4e6);
  const config::signals::Pressures found = bench.sample().pressures;
  EXPECT_TRUE(std::isnan(found.supply_Pa));
  EXPECT_EQ(found.in_Pa, 4e6);
  EXPECT_TRUE(std::isnan(found.out_Pa));
  EXPECT_FALSE(found.chambers());
}

TEST(Pressures, CountOnlyWhileTheirReadingIsGood) {
  LoopBench bench;
  const auto supply = add(bench, InputRole::supply_pressure, 7e6);
  const auto in = add(bench, InputRole::pressure_in, 4e6);
  // An uncertain one is at the end of a converter's range, and the truth may lie beyond.
  for (const Quality quality : {Quality::uncertain, Quality::stale, Quality::bad}) {
    supply->quality = quality;
    const config::signals::Pressures found = bench.sample().pressures;
    EXPECT_TRUE(std::isnan(found.supply_Pa)) << static_cast<int>(quality);
    EXPECT_EQ(found.in_Pa, 4e6) << "the other one is good";
  }
  supply->quality = Quality::good;
  EXPECT_EQ(bench.sample().pressures.supply_Pa, 7e6) << "good again";
  for (const double value : {hal::kMissing, static_cast<double>(INFINITY)}) {
    supply->value = value;
    EXPECT_TRUE(std::isnan(bench.sample().pressures.supply_Pa));
  }
}

}  // namespace
}  // namespace monitor::rt
