// The moments at which a trigger fires, by hand.
#include "workbench/serve/trigger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace workbench::serve {
namespace {

using Edge = TriggerSettings::Edge;
using Mode = TriggerSettings::Mode;

/// A triangle between -1 and 1 of 4 s, sampled at 10 Hz from t = 0 where it is 0 and rises.
double triangle(double t_s) {
  const double phase = std::fmod(t_s + 1.0, 4.0);
  return phase < 2.0 ? phase - 1.0 : 3.0 - phase;
}

std::vector<Trigger::Span> fired(Trigger& trigger, int samples) {
  std::vector<Trigger::Span> spans;
  for (int k = 0; k <= samples; ++k) {
    if (const auto span = trigger.add(0.1 * k, triangle(0.1 * k))) spans.push_back(*span);
  }
  return spans;
}

TriggerSettings at(double level, Edge edge) {
  TriggerSettings settings;
  settings.mode = Mode::normal;
  settings.level = level;
  settings.edge = edge;
  settings.window_s = 1.0;
  settings.before_ratio = 0.2;
  return settings;
}

constexpr double kTolerance_s = 1e-9;  // rounding of sums of 0.1

TEST(Trigger, FiresWhereTheLevelIsCrossedBetweenSamples) {
  Trigger trigger(at(0.55, Edge::rising));
  const auto spans = fired(trigger, 70);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_NEAR(spans[0].at_s, 0.55, kTolerance_s);
  EXPECT_NEAR(spans[0].from_s, 0.35, kTolerance_s);
  EXPECT_NEAR(spans[0].to_s, 1.35, kTolerance_s);
  EXPECT_NEAR(spans[1].at_s, 4.55, kTolerance_s);
}

TEST(Trigger, KnowsTheEdges) {
  Trigger falling(at(0.55, Edge::falling));
  EXPECT_NEAR(fired(falling, 30).at(0).at_s, 1.45, kTolerance_s);
  Trigger either(at(0.55, Edge::either));
  // The falling edge at 1.45 s comes after the capture up to 1.35 s.
  const auto spans = fired(either, 30);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_NEAR(spans[1].at_s, 1.45, kTolerance_s);
}

TEST(Trigger, HoldsOffAfterACapture) {
  TriggerSettings settings = at(0.55, Edge::rising);
  settings.hold_off_s = 4.0;  // to 5.35 s, over the crossing at 4.55 s
  Trigger trigger(settings);
  const auto spans = fired(trigger, 110);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_NEAR(spans[1].at_s, 8.55, kTolerance_s);
}

TEST(Trigger, ASingleOneStops) {
  TriggerSettings settings = at(0.55, Edge::rising);
  settings.mode = Mode::single;
  Trigger trigger(settings);
  EXPECT_STREQ(trigger.state(), "waiting");
  EXPECT_EQ(fired(trigger, 110).size(), 1U);
  EXPECT_STREQ(trigger.state(), "stopped");
}

TEST(Trigger, NothingCrossesOverAGapOrBeforeTheFirstSample) {
  Trigger trigger(at(0.55, Edge::rising));
  EXPECT_FALSE(trigger.add(0.0, 0.0));
  EXPECT_FALSE(trigger.add(0.1, std::nan("")));
  EXPECT_FALSE(trigger.add(0.2, 1.0));
  EXPECT_STREQ(trigger.state(), "waiting");
  Trigger fresh(at(0.55, Edge::rising));
  EXPECT_FALSE(fresh.add(0.0, 1.0));
  EXPECT_STREQ(fresh.state(), "waiting");
}

TEST(Trigger, AClockThatWentBackBeginsAgain) {
  Trigger trigger(at(0.5, Edge::rising));
  EXPECT_FALSE(trigger.add(100.0, 0.0));
  EXPECT_FALSE(trigger.add(100.1, 1.0));
  EXPECT_STREQ(trigger.state(), "capturing");
  EXPECT_FALSE(trigger.add(1.0, 1.0));
  EXPECT_STREQ(trigger.state(), "waiting");
}

TEST(Trigger, WithoutOneNothingIsCaptured) {
  Trigger trigger;
  EXPECT_TRUE(fired(trigger, 100).empty());
  EXPECT_STREQ(trigger.state(), "off");
}

}  // namespace
}  // namespace workbench::serve
