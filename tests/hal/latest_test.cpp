#include "hal/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
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
  constexpr int kDifferent = 20'000;
  using Value = std::array<long, 64>;
  Latest<Value> latest;
  std::atomic<bool> enough{false};
  std::thread writer([&] {
    Value value;
    for (long i = 1; !enough; ++i) {
      value.fill(i);
      latest.put(value);
    }
  });
  long last = 0;
  bool torn = false;
  bool back = false;
  for (int different = 0; different < kDifferent;) {
    const Value& value = latest.get();
    for (const long part : value) torn = torn || part != value[0];
    back = back || value[0] < last;
    if (value[0] != last) ++different;
    last = value[0];
  }
  enough = true;
  writer.join();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(back);
}

}  // namespace
}  // namespace hal
