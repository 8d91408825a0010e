// The thread and the hand-over, with a source that is fed from another thread.
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "hal/encoder/encoder.h"
#include "tests/count_allocations.h"
#include "tests/hal/encoder/fake_source.h"

namespace hal::encoder {
namespace {

using testing::edge_between;
using testing::FakeSource;

/// The fake chip for two threads; stuck: its wait() returns only when released.
class SharedSource final : public EdgeSource {
 public:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    FakeSource chip;
    bool stuck = false;
  };
  explicit SharedSource(std::shared_ptr<State> state) : state_(std::move(state)) {}

  Wake wait(std::int64_t timeout_ns) noexcept override {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait(lock, [this] { return !state_->stuck; });
    state_->changed.wait_for(lock, std::chrono::nanoseconds(timeout_ns),
                             [this] { return state_->chip.wait(0) != Wake::timeout; });
    return state_->chip.wait(0);
  }
  Drained drain(std::span<Edge, kBatch> into) noexcept override {
    const std::lock_guard lock(state_->mutex);
    return state_->chip.drain(into);
  }
  std::optional<Levels> levels() noexcept override {
    const std::lock_guard lock(state_->mutex);
    return state_->chip.levels();
  }

 private:
  std::shared_ptr<State> state_;
};

constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr double kCount_m = 5e-5;

struct Rig {
  explicit Rig(bool has_index = false)
      : watch(std::make_shared<EncoderWatch>(std::make_unique<SharedSource>(state),
                                             std::vector<std::shared_ptr<GpioLine>>{},
                                             TrackerOptions{4, 1e9, has_index}, kPeriod_ns, 0)),
        rod(watch, kCount_m, 0.1) {}

  void move_to(std::int64_t to) {
    const std::lock_guard lock(state->mutex);
    while (quarter != to) {
      const std::int64_t next = quarter + (to > quarter ? 1 : -1);
      state->chip.move(edge_between(quarter, next, monotonic_ns()));
      quarter = next;
    }
    state->changed.notify_all();
  }
  void stick(bool stuck) {
    const std::lock_guard lock(state->mutex);
    state->stuck = stuck;
    state->changed.notify_all();
  }
  /// Reads until `done` says so, for at most 10 s.
  template <class Done>
  Reading read_until(Done done) {
    const std::int64_t end_ns = monotonic_ns() + 10'000'000'000;
    Reading reading = rod.read({});
    while (!done(reading) && monotonic_ns() < end_ns) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      reading = rod.read({});
    }
    return reading;
  }

  std::shared_ptr<SharedSource::State> state = std::make_shared<SharedSource::State>();
  std::shared_ptr<EncoderWatch> watch;
  EncoderRod rod;
  std::int64_t quarter = 0;
};

TEST(EncoderRod, GivesTheReferencePlusTheCounts) {
  Rig rig;
  EXPECT_DOUBLE_EQ(rig.rod.read({}).y_m, 0.1);
  rig.move_to(-12);
  const double expected_m = 0.1 - 12 * kCount_m;
  const auto arrived = [&](const Reading& r) { return std::abs(r.y_m - expected_m) < 1e-12; };
  const Reading reading = rig.read_until(arrived);
  EXPECT_DOUBLE_EQ(reading.y_m, expected_m);
  EXPECT_EQ(reading.quality, config::signals::Quality::good);
  EXPECT_LE(reading.t_ns, monotonic_ns());
}

TEST(EncoderRod, HasNoValueAnyMoreWhileItsThreadHangsAndIsGoodAgainAfterwards) {
  Rig rig;
  rig.stick(true);
  const Reading bad =
      rig.read_until([](const Reading& r) { return r.quality == config::signals::Quality::bad; });
  EXPECT_EQ(bad.quality, config::signals::Quality::bad);
  EXPECT_TRUE(std::isnan(bad.y_m));
  EXPECT_GT(monotonic_ns() - bad.t_ns, kBadPeriods * kPeriod_ns) << "the time says since when";
  rig.stick(false);
  const Reading good =
      rig.read_until([](const Reading& r) { return r.quality == config::signals::Quality::good; });
  EXPECT_EQ(good.quality, config::signals::Quality::good);
}

TEST(Freshness, IsStaleAfterThreePeriodsAndBadAfterSix) {
  EXPECT_EQ(freshness(15, 5), config::signals::Quality::good);
  EXPECT_EQ(freshness(16, 5), config::signals::Quality::stale);
  EXPECT_EQ(freshness(30, 5), config::signals::Quality::stale);
  EXPECT_EQ(freshness(31, 5), config::signals::Quality::bad);
}

TEST(EncoderRod, IsUncertainBeforeTheIndexAndAfterReferNoMore) {
  Rig rig(true);
  EXPECT_EQ(rig.rod.read({}).quality, config::signals::Quality::uncertain);
  rig.watch->refer();
  EXPECT_EQ(
      rig.read_until([](const Reading& r) { return r.quality == config::signals::Quality::good; })
          .quality,
      config::signals::Quality::good);
}

TEST(EncoderRod, ReadingAllocatesNothing) {
  Rig rig;
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) rig.rod.read({});
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace hal::encoder
