#include "hal/encoder/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/hal/encoder/fake_source.h"

namespace hal::encoder {
namespace {

using testing::edge_between;
using testing::edges_of;
using testing::FakeSource;
using testing::levels_in;

std::int64_t test_now_ns = 0;
std::int64_t test_clock() { return test_now_ns; }

constexpr TrackerOptions kOptions{4, 100'000.0, false};

struct Bench {
  explicit Bench(const TrackerOptions& options = kOptions) : tracker(options, levels_in(0)) {
    test_now_ns = 1'000'000'000;
  }
  /// One quarter after another, `gap_ns` apart; not fetched.
  void move_to(std::int64_t to, std::int64_t gap_ns = 100'000) {
    while (quarter != to) {
      const std::int64_t next = quarter + (to > quarter ? 1 : -1);
      source.move(edge_between(quarter, next, t_ns += gap_ns));
      quarter = next;
    }
  }
  const EncoderSnapshot& step(std::int64_t later_ns = 2'000'000) {
    test_now_ns += later_ns;
    tracker.step(source, later_ns, test_clock);
    return tracker.snapshot();
  }

  FakeSource source;
  Tracker tracker;
  std::int64_t quarter = 0;
  std::int64_t t_ns = 0;
};

TEST(Tracker, BatchesOfBothLinesAreMergedInTheOrderOfTime) {
  const auto y_quarters = [](double t_s) {
    return 0.5 + 300.0 * std::sin(2.0 * std::numbers::pi * t_s);
  };
  Bench bench;
  const std::vector<Edge> edges = edges_of(y_quarters, 1.3, 5e-5);
  std::size_t batch = 0;
  for (std::size_t i = 0; i < edges.size(); ++batch) {
    for (std::size_t n = 1 + batch % 20; n > 0 && i < edges.size(); --n) {
      bench.source.move(edges[i++]);
    }
    const EncoderSnapshot& now = bench.step();
    const double after_s = (static_cast<double>(edges[i - 1].t_ns) + 500.0) * 1e-9;
    ASSERT_EQ(now.counts, testing::quarter_at(y_quarters, after_s));
    ASSERT_EQ(now.edge_ns, edges[i - 1].t_ns);
  }
  EXPECT_FALSE(bench.tracker.snapshot().lost);
  EXPECT_EQ(bench.tracker.snapshot().edges, static_cast<std::int64_t>(edges.size()));
}

TEST(Tracker, EdgesFromBeforeTheStartDoNotCount) {
  FakeSource source;
  source.move({1, EncoderLine::a, true});
  source.move({2, EncoderLine::b, true});
  const std::optional<Levels> levels = still_levels(source);
  ASSERT_TRUE(levels.has_value());
  EXPECT_EQ(*levels, levels_in(2));
  Tracker tracker(kOptions, levels);
  test_now_ns = 1'000'000'000;
  tracker.step(source, 0, test_clock);
  EXPECT_EQ(tracker.snapshot().counts, 0);
  EXPECT_FALSE(tracker.snapshot().lost);
  Tracker without(kOptions, std::nullopt);
  without.step(source, 0, test_clock);
  EXPECT_TRUE(without.snapshot().lost);
}

TEST(Tracker, AnEdgeThatComesLateIsPutInItsPlace) {
  Bench bench;
  bench.move_to(9);
  bench.step();
  const Edge late = edge_between(9, 10, bench.t_ns += 1000);
  bench.source.hold_back(late);
  bench.source.move(edge_between(10, 11, bench.t_ns += 1000));
  EXPECT_EQ(bench.step(0).counts, 8) << "without the missing edge it seems to go back";
  bench.source.release();
  const EncoderSnapshot& now = bench.step(0);
  EXPECT_EQ(now.counts, 11);
  EXPECT_EQ(now.late, 1);
  EXPECT_FALSE(now.lost);
}

TEST(Tracker, AnEdgeThatComesLaterThanItCanUndoMakesTheCountUncertain) {
  Bench bench;
  bench.source.hold_back(edge_between(0, 1, bench.t_ns += 20'000));
  for (int i = 0; i < 20; ++i) {  // B dithers: more edges than are kept
    bench.source.move(edge_between(1, 2, bench.t_ns += 20'000));
    bench.source.move(edge_between(2, 1, bench.t_ns += 20'000));
    bench.step(0);
  }
  EXPECT_FALSE(bench.tracker.snapshot().lost) << "nothing contradicts it yet";
  bench.source.move(edge_between(1, 0, bench.t_ns += 20'000));
  EXPECT_TRUE(bench.step(0).lost) << "A falls though it never rose";
  bench.source.release();
  EXPECT_TRUE(bench.step(0).lost) << "it has risen, but too long ago";
}

TEST(Tracker, AFullQueueMakesTheCountUncertainUntilItIsReferred) {
  Bench bench;
  bench.move_to(30);
  EXPECT_FALSE(bench.step().lost) << "15 edges a line are all there";
  bench.move_to(30 + 64);
  const EncoderSnapshot& now = bench.step();
  EXPECT_TRUE(now.lost);
  EXPECT_EQ(now.overflows, 1);
  EXPECT_EQ(now.times_lost, 1);
  EXPECT_EQ(now.counts, 30 + 32) << "the newest were dropped";
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(bench.step().lost);
  bench.tracker.refer();
  EXPECT_FALSE(bench.step().lost);
  bench.move_to(104);
  EXPECT_EQ(bench.step().counts, 10);
  EXPECT_FALSE(bench.tracker.snapshot().lost);
}

TEST(Tracker, LevelsThatStayDifferentTellOfAMissingEdge) {
  Bench bench;
  bench.move_to(5);
  EXPECT_FALSE(bench.step().lost);
  bench.source.jump(levels_in(6));
  EXPECT_FALSE(bench.step().lost) << "the edge may be on its way";
  EXPECT_FALSE(bench.step().lost);
  const EncoderSnapshot& now = bench.step();
  EXPECT_TRUE(now.lost);
  EXPECT_EQ(now.disagreements, 1);
  EXPECT_EQ(now.counts, 6);
  bench.step();
  EXPECT_EQ(bench.tracker.snapshot().disagreements, 1) << "told once";
}

TEST(Tracker, LevelsThatWereOnlyAheadOfTheirEdgeAreNoLoss) {
  Bench bench;
  bench.move_to(5);
  bench.step();
  bench.source.jump(levels_in(6));
  bench.step();
  bench.step();
  bench.move_to(6);
  bench.step();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(bench.step().lost);
  EXPECT_EQ(bench.tracker.snapshot().counts, 6);
}

TEST(Tracker, TheReadingIsUncertainFromEightTenthsOfThePermittedRate) {
  Bench bench;  // permitted: 100 edges in a millisecond, 1000 in the window of 10 ms
  for (const auto& [per_ms, fast] : {std::pair{75, false}, {85, true}, {70, false}}) {
    for (int ms = 0; ms < 30; ++ms) {
      for (int part = 0; part < 5; ++part) {
        bench.move_to(bench.quarter + per_ms / 5, 1'000'000 / per_ms);
        bench.step(200'000);
      }
    }
    EXPECT_EQ(bench.tracker.snapshot().too_fast, fast) << per_ms;
    EXPECT_NEAR(bench.tracker.snapshot().edges_per_s, per_ms * 1e3, 1.0);
  }
  EXPECT_EQ(bench.tracker.snapshot().times_too_fast, 1);
  EXPECT_FALSE(bench.tracker.snapshot().lost) << "fast, but complete";
}

TEST(Tracker, EdgesFasterThanPermittedMayHaveLostSomeWithoutATrace) {
  Bench bench;  // permitted: eight edges in 80 us
  bench.move_to(20, 11'000);
  EXPECT_FALSE(bench.step().lost);
  bench.move_to(27, 14'000);
  bench.move_to(29, 1'000);
  EXPECT_FALSE(bench.step().lost) << "both lines at once: an interrupt that came late";
  bench.move_to(40, 14'000);
  EXPECT_FALSE(bench.step().lost);
  bench.move_to(60, 9'000);
  const EncoderSnapshot& now = bench.step();
  EXPECT_TRUE(now.lost);
  EXPECT_GE(now.bursts, 1);
  EXPECT_EQ(now.counts, 60);
}

TEST(Tracker, IsNotHomedBeforeTheIndex) {
  Bench bench({4, 100'000.0, true});
  bench.move_to(10);
  EXPECT_FALSE(bench.step().homed);
  bench.source.move({bench.t_ns += 1000, EncoderLine::index, true});
  bench.move_to(13);
  const EncoderSnapshot& now = bench.step();
  EXPECT_TRUE(now.homed);
  EXPECT_EQ(now.counts, 3);
}

TEST(Tracker, AFailureIsToldAsLongAsItLasts) {
  Bench bench;
  bench.source.fail(true);
  EXPECT_TRUE(bench.step().failed);
  bench.source.fail(false);
  EXPECT_FALSE(bench.step().failed);
}

}  // namespace
}  // namespace hal::encoder
