#include "hal/encoder/quadrature.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/hal/encoder/motion.h"

namespace hal::encoder {
namespace {

using testing::edges_of;
using testing::levels_in;

/// Starts at rest in quarter 0, moves 1000 quarters up and 200 below where it began.
double sine_quarters(double t_s) {
  return 0.5 + 400.0 * (1.0 - std::cos(2.0 * std::numbers::pi * t_s)) +
         200.0 * std::sin(4.0 * std::numbers::pi * t_s);
}

class Modes : public ::testing::TestWithParam<int> {};

TEST_P(Modes, CountsOfASineAreTheClosedFormsAfterEveryEdge) {
  const std::int64_t divisor = 4 / GetParam();
  QuadratureDecoder decoder(levels_in(0));
  const std::vector<Edge> edges = edges_of(sine_quarters, 2.0, 5e-5);
  ASSERT_GT(edges.size(), 3000U);
  for (const Edge& edge : edges) {
    decoder.edge(edge);
    const double after_s = (static_cast<double>(edge.t_ns) + 500.0) * 1e-9;
    const auto expected = static_cast<std::int64_t>(
        std::floor(std::floor(sine_quarters(after_s)) / static_cast<double>(divisor)));
    ASSERT_EQ(decoder.counts(GetParam()), expected) << "at " << after_s << " s";
  }
  EXPECT_EQ(decoder.illegal(), 0);
  EXPECT_FALSE(decoder.lost());
}

INSTANTIATE_TEST_SUITE_P(X, Modes, ::testing::Values(1, 2, 4));

TEST(Quadrature, DitherOnOneEdgeDoesNotCreepInAnyMode) {
  for (int start = 0; start < 4; ++start) {
    QuadratureDecoder decoder(levels_in(start));
    for (int i = 0; i < 1000; ++i) {
      decoder.edge(testing::edge_between(start, start + 1, 0));
      EXPECT_EQ(decoder.direction(), 1);
      decoder.edge(testing::edge_between(start + 1, start, 0));
      EXPECT_EQ(decoder.direction(), -1);
    }
    for (const int per_cycle : {1, 2, 4}) EXPECT_EQ(decoder.counts(per_cycle), 0) << start;
    EXPECT_EQ(decoder.illegal(), 0);
  }
}

TEST(Quadrature, AnEdgeToTheLevelThatWasIsIllegalAndMakesTheCountUncertain) {
  QuadratureDecoder decoder(levels_in(0));
  decoder.edge({1, EncoderLine::a, true});
  decoder.edge({2, EncoderLine::a, true});
  EXPECT_EQ(decoder.counts(4), 1);
  EXPECT_EQ(decoder.illegal(), 1);
  EXPECT_TRUE(decoder.lost());
  decoder.refer();
  EXPECT_FALSE(decoder.lost());
  EXPECT_EQ(decoder.counts(4), 0);
}

TEST(Quadrature, ResyncMovesOneQuarterWhereOneLevelDiffersAndKeepsThePhaseElsewhere) {
  QuadratureDecoder one(levels_in(0));
  one.resync(levels_in(3));
  EXPECT_EQ(one.counts(4), -1);
  EXPECT_TRUE(one.lost());
  QuadratureDecoder both(levels_in(0));
  both.resync(levels_in(2));
  both.refer();
  QuadratureDecoder coarse = both;
  coarse.edge(testing::edge_between(2, 3, 0));
  coarse.edge(testing::edge_between(3, 4, 0));
  EXPECT_EQ(coarse.counts(1), 1) << "a cycle begins in phase 0";
  for (std::int64_t quarter = 2; quarter < 10; ++quarter) {
    both.edge(testing::edge_between(quarter, quarter + 1, 0));
  }
  EXPECT_EQ(both.counts(4), 8);
  EXPECT_EQ(both.illegal(), 0);
}

/// Walks from quarter to quarter; the index pulse is high in quarters 100 to 102.
void walk(QuadratureDecoder& decoder, std::int64_t& quarter, std::int64_t to) {
  while (quarter != to) {
    const std::int64_t next = quarter + (to > quarter ? 1 : -1);
    decoder.edge(testing::edge_between(quarter, next, 0));
    const auto index = [](std::int64_t q) { return q >= 100 && q <= 102; };
    if (index(quarter) != index(next)) decoder.edge({0, EncoderLine::index, index(next)});
    quarter = next;
  }
}

TEST(Quadrature, TheIndexSetsTheSameOriginFromBothSides) {
  QuadratureDecoder up(levels_in(0));
  std::int64_t quarter = 0;
  walk(up, quarter, 140);
  EXPECT_EQ(up.counts(4), 40);
  QuadratureDecoder down(levels_in(0));
  quarter = 200;
  walk(down, quarter, 60);
  EXPECT_EQ(down.counts(4), -39) << "the flank at 100 was passed from 100 to 99";
  walk(down, quarter, 140);
  EXPECT_EQ(down.slips(), 0) << "one quarter apart is no difference";
  EXPECT_EQ(down.captures(), 2);
}

TEST(Quadrature, TheIndexMendsACountThatHadLostEdgesAndTellsOfTheSlip) {
  QuadratureDecoder decoder(levels_in(0));
  std::int64_t quarter = 0;
  walk(decoder, quarter, 140);
  quarter += 8;  // two whole cycles go unseen
  decoder.mark_lost();
  EXPECT_EQ(decoder.counts(4), 40);
  walk(decoder, quarter, 50);
  EXPECT_FALSE(decoder.lost());
  EXPECT_EQ(decoder.slips(), 1);
  walk(decoder, quarter, 140);
  EXPECT_NEAR(static_cast<double>(decoder.counts(4)), 40.0, 1.0);
}

}  // namespace
}  // namespace hal::encoder
