#include <gmock/gmock.h>

#include <thread>

#include "hal/comedi/devices.h"
#include "tests/count_allocations.h"
#include "tests/hal/comedi/fake_board.h"

namespace hal::comedi {
namespace {

using ::testing::ElementsAre;
using testing::FakeBoard;
using ::testing::IsEmpty;

constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr ConverterSpan kSpan{-10.0, 10.0, 2000};  // 10 mV a step
constexpr BoardChannel kOutput{1, 0, 0, 0};

std::vector<BoardChannel> channels(unsigned count) {
  std::vector<BoardChannel> places;
  for (unsigned i = 0; i < count; ++i) places.push_back({0, i, 0, 0});
  return places;
}

struct Rig {
  explicit Rig(bool threaded, unsigned inputs = 1)
      : exchange(std::make_shared<Exchange>(board, channels(inputs), kOutput, kPeriod_ns)) {
    board->set(0, 1100);
    exchange->start(threaded, 0);
  }
  ~Rig() { board->stick(false); }

  Tick next() { return {++index, index * kPeriod_ns}; }
  /// Waits at most 10 s until `done` holds.
  template <class Done>
  static bool eventually(Done done) {
    const std::int64_t end_ns = monotonic_ns() + 10'000'000'000;
    while (!done()) {
      if (monotonic_ns() > end_ns) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  std::shared_ptr<FakeBoard> board = std::make_shared<FakeBoard>();
  std::shared_ptr<Exchange> exchange;
  std::int64_t index = 0;
};

class Both : public ::testing::TestWithParam<bool> {};

TEST_P(Both, WritesACommandThroughScaleOffsetAndPolarity) {
  Rig rig(GetParam());
  AnalogValve valve(rig.exchange, kSpan, {-0.5, 1.0}, 0.2);
  EXPECT_THAT(rig.board->written(), IsEmpty()) << "nothing is written when it opens";
  const Applied applied = valve.write(4.014, rig.next());
  EXPECT_NEAR(applied.u_V, 4.02, 1e-12) << "1 - 2.007 V is -1.01 V at the nearest code";
  EXPECT_TRUE(applied.good);
  ASSERT_TRUE(Rig::eventually([&] { return rig.board->written().size() == 1; }));
  EXPECT_THAT(rig.board->written(), ElementsAre(899));
}

TEST_P(Both, GoesToNullAtOnce) {
  Rig rig(GetParam());
  AnalogValve valve(rig.exchange, kSpan, {-0.5, 1.0}, 0.2);
  const Applied applied = valve.go_null();
  EXPECT_NEAR(applied.u_V, 0.2, 1e-12);
  EXPECT_TRUE(applied.good);
  ASSERT_FALSE(rig.board->written().empty()) << "not left to the thread";
  EXPECT_EQ(rig.board->written().front(), 1090U);
}

TEST_P(Both, ReadsAnInputInItsUnit) {
  Rig rig(GetParam());
  AnalogInput pressure(rig.exchange, {0, kSpan, {2e6, -1e5}});
  const InputReading reading = pressure.read(rig.next());
  EXPECT_NEAR(reading.value, 2e6 - 1e5, 1e-6) << "1 V";
  EXPECT_EQ(reading.quality, config::signals::Quality::good);
  EXPECT_GT(reading.t_ns, 0);
  rig.board->set(0, 2000);
  EXPECT_TRUE(Rig::eventually([&] {
    return pressure.read(rig.next()).quality == config::signals::Quality::uncertain;
  })) << "at the end of the range";
}

TEST_P(Both, AReadingThatFailedIsMissingAndBad) {
  Rig rig(GetParam());
  AnalogRod rod(rig.exchange, {0, kSpan, {0.01, 0.0}});
  EXPECT_NEAR(rod.read(rig.next()).y_m, 0.01, 1e-12);
  rig.board->fail(true);
  EXPECT_TRUE(Rig::eventually([&] {
    const Reading reading = rod.read(rig.next());
    return std::isnan(reading.y_m) && reading.quality == config::signals::Quality::bad;
  }));
}

TEST_P(Both, ACommandThatTheBoardRefusesIsTold) {
  Rig rig(GetParam());
  AnalogValve valve(rig.exchange, kSpan, {}, 0.0);
  rig.board->fail(true);
  EXPECT_TRUE(Rig::eventually([&] { return !valve.write(1.0, rig.next()).good; }));
  rig.board->fail(false);
  EXPECT_TRUE(Rig::eventually([&] { return valve.write(1.0, rig.next()).good; }));
}

TEST(Exchange, TheLoopsCallsAllocateNothing) {
  Rig rig(true);
  AnalogValve valve(rig.exchange, kSpan, {}, 0.0);
  CounterRod rod(rig.exchange, 0, 16, {1e-5, 0.0});
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    rod.read(rig.next());
    valve.write(0.01 * i, {rig.index, 0});
  }
  EXPECT_EQ(allocations, before);
}

INSTANTIATE_TEST_SUITE_P(Threaded, Both, ::testing::Bool());

TEST(CounterRod, CountsThroughTheWrapFromWhereItStarted) {
  Rig rig(false);
  CounterRod rod(rig.exchange, 0, 16, {-1e-5, 0.3});
  rig.board->set(0, 65'530);
  EXPECT_DOUBLE_EQ(rod.read(rig.next()).y_m, 0.3);
  rig.board->set(0, 4);
  EXPECT_DOUBLE_EQ(rod.read(rig.next()).y_m, 0.3 - 10e-5);
}

TEST(Exchange, WithoutAThreadReadsOnceATick) {
  Rig rig(false, 2);
  AnalogInput first(rig.exchange, {0, kSpan, {}});
  AnalogInput second(rig.exchange, {1, kSpan, {}});
  const int before = rig.board->reads();
  for (int i = 0; i < 10; ++i) {
    const Tick tick = rig.next();
    first.read(tick);
    second.read(tick);
  }
  EXPECT_EQ(rig.board->reads() - before, 20);
}

TEST(Exchange, ABoardThatHangsNeverHoldsTheLoopAndIsTold) {
  Rig rig(true);
  AnalogValve valve(rig.exchange, kSpan, {}, 0.0);
  AnalogRod rod(rig.exchange, {0, kSpan, {0.01, 0.0}});
  rig.board->stick(true);
  EXPECT_TRUE(Rig::eventually([&] { return !valve.write(1.0, rig.next()).good; }));
  EXPECT_TRUE(Rig::eventually(
      [&] { return rod.read(rig.next()).quality == config::signals::Quality::bad; }));
  EXPECT_TRUE(std::isnan(rod.read(rig.next()).y_m));
  for (int i = 0; i < 5; ++i) valve.write(2.0 + i, rig.next());
  rig.board->stick(false);
  EXPECT_TRUE(Rig::eventually([&] { return !rig.board->written().empty(); }));
  EXPECT_TRUE(Rig::eventually([&] { return rig.board->written().back() == 1600U; }))
      << "the newest command, 6 V";
  EXPECT_LE(rig.board->written().size(), 3U) << "those in between are not made up for";
  EXPECT_TRUE(Rig::eventually(
      [&] { return rod.read(rig.next()).quality == config::signals::Quality::good; }));
}

}  // namespace
}  // namespace hal::comedi
