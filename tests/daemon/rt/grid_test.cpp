#include "daemon/rt/grid.h"

#include <gtest/gtest.h>

namespace monitor::rt {
namespace {

constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr std::int64_t kStart_ns = 123'456;

TEST(Grid, WakesAtWholePeriodsFromItsStart) {
  VirtualClock clock;
  Grid grid(kStart_ns, kPeriod_ns);
  for (std::int64_t n = 0; n < 1000; ++n) {
    const Period period = grid.next(clock);
    EXPECT_EQ(period.tick.index, n);
    EXPECT_EQ(period.tick.nominal_ns, n * kPeriod_ns);
    EXPECT_EQ(period.skipped, 0);
    EXPECT_EQ(clock.now_ns(), kStart_ns + n * kPeriod_ns);
    clock.advance_ns((n * 7919) % kPeriod_ns);  // work of any length within the period
  }
}

TEST(Grid, ReportsTheLatenessOfAWakeUpWithinItsPeriod) {
  VirtualClock clock;
  Grid grid(0, kPeriod_ns);
  grid.next(clock);
  clock.advance_ns(kPeriod_ns + 700'000);
  const Period period = grid.next(clock);
  EXPECT_EQ(period.tick.index, 1);
  EXPECT_EQ(period.lateness_ns, 700'000);
  EXPECT_EQ(period.skipped, 0);
}

TEST(Grid, SkipsWholePeriodsAndKeepsThePhase) {
  for (std::int64_t k = 1; k < 40; ++k) {
    VirtualClock clock;
    Grid grid(kStart_ns, kPeriod_ns);
    grid.next(clock);
    // Tick 1 is due one period after tick 0; it is missed by k - 1 and a half periods more.
    clock.advance_ns(kPeriod_ns + k * kPeriod_ns + kPeriod_ns / 2);
    const Period period = grid.next(clock);
    EXPECT_EQ(period.skipped, k + 1);
    EXPECT_EQ(period.tick.index, k + 2);
    EXPECT_EQ(period.overrun_ns, k * kPeriod_ns + kPeriod_ns / 2);
    EXPECT_EQ(period.lateness_ns, 0);
    EXPECT_EQ(clock.now_ns(), kStart_ns + period.tick.index * kPeriod_ns) << "phase lost";
    EXPECT_EQ(grid.next(clock).tick.index, k + 3);
  }
}

}  // namespace
}  // namespace monitor::rt
