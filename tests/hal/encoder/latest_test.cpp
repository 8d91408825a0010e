#include "hal/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace hal {
namespace {

TEST(Latest, GivesTheFirstValueUntilThereIsANewerAndThenTheNewest) {
  Latest<int> latest(7);
  EXPECT_EQ(latest.get(), 7);
  latest.put(8);
  latest.put(9);
  EXPECT_EQ(latest.get(), 9);
  EXPECT_EQ(latest.get(), 9);
  latest.put(10);
  EXPECT_EQ(latest.get(), 10);
}

TEST(Latest, IsNeverTornAndNeverGoesBackUnderTwoThreads) {
  constexpr long kValues = 200'000;
  using Value = std::array<long, 32>;
  Latest<Value> latest;
  std::thread writer([&] {
    Value value;
    for (long i = 1; i <= kValues; ++i) {
      value.fill(i);
      latest.put(value);
    }
  });
  long last = 0;
  bool torn = false;
  bool back = false;
  while (last < kValues) {
    const Value& value = latest.get();
    for (const long part : value) torn = torn || part != value[0];
    back = back || value[0] < last;
    last = value[0];
  }
  writer.join();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(back);
}

}  // namespace
}  // namespace hal
