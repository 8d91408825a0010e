// Properties of every method of estimation: batch, sliding, recursive.
#include <gtest/gtest.h>

#include <cmath>

#include "estimator/estimate.h"
#include "tests/estimator/fdi/watched_integrator.h"

namespace estimator::fdi {
namespace {

using fdi_test::Integrator;
using fdi_test::kGain_m_per_V;
using fdi_test::kSampleTime_s;
using fdi_test::Recorder;
using fdi_test::run;
using fdi_test::watched;

class EveryMethod : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::Values("batch", "sliding", "recursive"));

TEST_P(EveryMethod, FindsTheGainAndRaisesTheAlarmWithItsDirectionWhenTheGainRises) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 600, seen);
  ASSERT_FALSE(seen.estimates.empty());
  EXPECT_TRUE(seen.estimates.back().valid) << seen.estimates.back().reason;
  EXPECT_NEAR(seen.estimates.back().b1, kGain_m_per_V, 1e-3 * kGain_m_per_V);
  EXPECT_TRUE(seen.alarms.empty());

  plant.gain_m_per_V = 1.2 * kGain_m_per_V;
  run(pipeline, plant, 2400, seen);
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].severity, Severity::major);
  EXPECT_EQ(seen.alarms[0].direction, 1);
  EXPECT_EQ(seen.alarms[0].parameter, "valve_gain_m_per_V");
  EXPECT_GT(seen.alarms[0].value, 2.1e-4);
  EXPECT_EQ(pipeline.alarms().active_count(), 1U);
}

TEST_P(EveryMethod, IsInvalidWhenNothingMoves) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  plant.amplitude_V = 0.0;
  Recorder seen;
  run(pipeline, plant, 1000, seen);
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].severity, Severity::invalid);
  EXPECT_FALSE(seen.estimates.back().valid);
  EXPECT_FALSE(seen.estimates.back().reason.empty());
}

TEST_P(EveryMethod, IsInvalidWhenThePositionIsStuckWhileTheCommandMoves) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  plant.gain_m_per_V = 0.0;
  Recorder seen;
  run(pipeline, plant, 1000, seen);
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].severity, Severity::invalid);
}

TEST_P(EveryMethod, IsInvalidAfterALongGapAndValidAgainOneWindowLater) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 400, seen);
  for (int i = 0; i < 100; ++i) plant.next();  // half a window lost
  config::signals::Sample first = plant.next();
  first.gap = 100;
  pipeline.process(first, seen);
  run(pipeline, plant, 99, seen);
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].severity, Severity::invalid);
  EXPECT_EQ(seen.estimates.back().reason, to_string(Reason::gap));
  run(pipeline, plant, 400, seen);
  ASSERT_EQ(seen.alarms.size(), 2U);
  EXPECT_EQ(seen.alarms[1].severity, Severity::ok);
  EXPECT_NEAR(seen.estimates.back().b1, kGain_m_per_V, 1e-3 * kGain_m_per_V);
}

TEST_P(EveryMethod, NoRegressorReachesAcrossAShortGap) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 290, seen);
  for (int i = 0; i < 5; ++i) plant.next();
  run(pipeline, plant, 105 + 200, seen);  // the ticks alone tell of the gap
  EXPECT_TRUE(seen.alarms.empty());
  EXPECT_TRUE(seen.estimates.back().valid);
  // A row across the gap would be wrong by five samples' travel, 10 %.
  EXPECT_NEAR(seen.estimates.back().b1, kGain_m_per_V, 1e-3 * kGain_m_per_V);
}

TEST_P(EveryMethod, IsInvalidWhenReadingsAreBadOrMissing) {
  for (const bool nan : {false, true}) {
    Pipeline pipeline(watched(GetParam()), kSampleTime_s);
    Integrator plant;
    Recorder seen;
    run(pipeline, plant, 400, seen);
    for (int i = 0; i < 200; ++i) {
      config::signals::Sample s = plant.next();
      if (i % 10 == 0 && nan) s.y_m = std::nan("");
      if (i % 10 == 0 && !nan) s.quality = config::signals::Quality::bad;
      pipeline.process(s, seen);
    }
    EXPECT_EQ(seen.estimates.back().reason, to_string(Reason::gap));
    EXPECT_FALSE(seen.estimates.back().valid);
  }
}

TEST_P(EveryMethod, IsInvalidWhileTheCommandIsSaturated) {
  Pipeline pipeline(watched(GetParam()), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 400, seen);
  for (int i = 0; i < 200; ++i) {
    config::signals::Sample s = plant.next();
    s.saturated = i % 5 == 0;  // 20 % of the window, 10 % are allowed
    pipeline.process(s, seen);
  }
  EXPECT_EQ(seen.estimates.back().reason, to_string(Reason::saturated));
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].severity, Severity::invalid);
}

}  // namespace
}  // namespace estimator::fdi
