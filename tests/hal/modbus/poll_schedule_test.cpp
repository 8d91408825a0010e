// When the thread looks for a command: against times worked out by hand.
#include "hal/modbus/poll_schedule.h"

#include <gtest/gtest.h>

namespace hal::modbus {
namespace {

constexpr std::int64_t kUs = 1000;
constexpr std::int64_t kMs = 1000 * kUs;
constexpr std::int64_t kPeriod = 5 * kMs;
constexpr std::int64_t kHandOver = 100 * kUs;
/// The loop's period 0 on the monotonic clock.
constexpr std::int64_t kStart = 7'000'123'456'789;
/// By which the grid may have crept later within the ticks of a test.
constexpr std::int64_t kCrept = 50 * kUs;

/// The loop calls in its period n, so long after that has begun.
std::int64_t call(PollSchedule& schedule, std::int64_t n, std::int64_t late) {
  const std::int64_t now = kStart + n * kPeriod + late;
  schedule.tick({n, n * kPeriod}, now);
  return now;
}

TEST(ModbusPollSchedule, KnowsWhenTheNextPeriodBeginsFromTheEarliestTick) {
  PollSchedule schedule(kPeriod, kHandOver);
  EXPECT_EQ(schedule.next_ns(kStart), kStart + kPeriod) << "the best that can be said";
  call(schedule, 0, 900 * kUs);
  call(schedule, 1, 30 * kUs);
  for (int n = 2; n < 100; ++n) call(schedule, n, n % 7 * 600 * kUs + 30 * kUs);
  const std::int64_t now = call(schedule, 100, 4'900 * kUs);
  EXPECT_GE(schedule.next_ns(now), kStart + 101 * kPeriod);
  EXPECT_LE(schedule.next_ns(now), kStart + 101 * kPeriod + 30 * kUs + kCrept);
}

TEST(ModbusPollSchedule, TakesNoHarmFromTicksThatWereLeftOut) {
  PollSchedule schedule(kPeriod, kHandOver);
  call(schedule, 0, 0);
  const std::int64_t now = call(schedule, 15, 2 * kMs);
  EXPECT_GE(schedule.next_ns(now), kStart + 16 * kPeriod);
  EXPECT_LE(schedule.next_ns(now), kStart + 16 * kPeriod + kUs);
}

TEST(ModbusPollSchedule, LearnsANewGridWhenTheLoopBeginsAgain) {
  PollSchedule schedule(kPeriod, kHandOver);
  call(schedule, 0, 0);
  const std::int64_t again = kStart + 1000 * kMs + 1'700 * kUs;
  schedule.tick({0, 0}, again);
  EXPECT_EQ(schedule.next_ns(again + 10 * kUs), again + kPeriod);
}

TEST(ModbusPollSchedule, LooksAHandOverAfterTheBeginningAndAgainEachHandOver) {
  const PollSchedule schedule(kPeriod, kHandOver);
  const std::int64_t begins = kStart + kPeriod;
  const auto look = [&](std::int64_t into) { return schedule.look_ns(begins, begins + into); };
  EXPECT_EQ(look(-4 * kMs), begins + 100 * kUs);
  EXPECT_EQ(look(0), begins + 100 * kUs);
  EXPECT_EQ(look(99 * kUs), begins + 100 * kUs);
  EXPECT_EQ(look(100 * kUs), begins + 200 * kUs);
  EXPECT_EQ(look(12'345 * kUs), begins + 12'400 * kUs) << "also when whole periods are gone";
}

TEST(ModbusPollSchedule, NeverLetsACommandWaitForMoreThanAHandOver) {
  const PollSchedule schedule(kPeriod, kHandOver);
  for (std::int64_t given = 0; given < 50 * kMs - kHandOver; given += 37 * kUs) {
    std::int64_t now = kStart - 3 * kMs;  // the thread has come back from the last command
    while (now < kStart + given) now = schedule.look_ns(kStart, now);
    EXPECT_LE(now - (kStart + given), kHandOver) << given;
  }
}

TEST(ModbusPollSchedule, LeavesItToTheLoopAfterFiftyMillisecondsWithoutACommand) {
  const PollSchedule schedule(kPeriod, kHandOver);
  EXPECT_EQ(schedule.look_ns(0, kStart), kNever_ns) << "no command yet";
  EXPECT_NE(schedule.look_ns(kStart, kStart + 50 * kMs - 1), kNever_ns);
  EXPECT_EQ(schedule.look_ns(kStart, kStart + 50 * kMs), kNever_ns);
}

}  // namespace
}  // namespace hal::modbus
