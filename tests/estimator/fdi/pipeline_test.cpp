#include "estimator/fdi/pipeline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/error.h"
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

TEST(Pipeline, CallsAWindowWithLittleCommandNotExcited) {
  PipelineConfig config = watched("sliding");
  config.estimators[0].min_u_rms_V = 1.0;
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  plant.amplitude_V = 1.3;  // 0.92 V rms
  Recorder seen;
  run(pipeline, plant, 600, seen);
  EXPECT_EQ(seen.estimates.back().reason, to_string(Reason::not_excited));
}

TEST(Pipeline, StaysSilentWhenTheRecordIsShorterThanItsWindow) {
  Pipeline pipeline(watched("batch"), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 199, seen);
  EXPECT_TRUE(seen.estimates.empty());
  EXPECT_TRUE(seen.alarms.empty());
}

TEST(Pipeline, MarksEstimatesBeforeTheFirstFullWindowAsTooShort) {
  Pipeline pipeline(watched("sliding"), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 199, seen);
  ASSERT_FALSE(seen.estimates.empty());
  for (const auto& estimate : seen.estimates) {
    EXPECT_FALSE(estimate.valid);
    EXPECT_TRUE(estimate.warming_up);
    EXPECT_EQ(estimate.reason, to_string(Reason::too_short));
  }
  EXPECT_TRUE(seen.alarms.empty());
}

// Arming states of sample_t.
constexpr std::uint8_t kDisarmed = 1;
constexpr std::uint8_t kRun = 3;

void run_in(std::uint8_t state, Pipeline& pipeline, Integrator& plant, int samples,
            Recorder& seen) {
  for (int i = 0; i < samples; ++i) {
    config::signals::Sample sample = plant.next();
    sample.state = state;
    pipeline.process(sample, seen);
  }
}

TEST(Pipeline, IsNotInvalidAtRestAndWarmsUpAgainWhenTheMotionStarts) {
  PipelineConfig config = watched("sliding");
  config.estimators[0].warmup_s = 2.0;
  config.estimators[0].min_u_rms_V = 0.5;
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  const double moving_V = plant.amplitude_V;
  Recorder seen;
  plant.amplitude_V = 0.0;
  run_in(kDisarmed, pipeline, plant, 1000, seen);
  EXPECT_TRUE(seen.alarms.empty()) << "no motion is asked for";
  run_in(kRun, pipeline, plant, 1000, seen);
  ASSERT_FALSE(seen.alarms.empty()) << "a motion is asked for and does not tell anything";
  EXPECT_EQ(seen.alarms.back().severity, Severity::invalid);
  run_in(kDisarmed, pipeline, plant, 50, seen);
  EXPECT_EQ(seen.alarms.back().severity, Severity::ok) << "INVALID ends with the motion";
  // A gain outside the band counts after the warm-up of this motion only.
  plant.amplitude_V = moving_V;
  plant.gain_m_per_V = 3e-4;
  const std::size_t before = seen.alarms.size();
  run_in(kRun, pipeline, plant, 395, seen);
  EXPECT_EQ(seen.alarms.size(), before);
  run_in(kRun, pipeline, plant, 400, seen);
  EXPECT_GT(seen.alarms.size(), before);
  EXPECT_EQ(seen.alarms.back().severity, Severity::major);
}

TEST(Pipeline, RaisesNoAlarmWithinTheWarmUp) {
  PipelineConfig config = watched("batch");
  config.estimators[0].warmup_s = 2.0;
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  plant.gain_m_per_V = 3e-4;
  Recorder seen;
  run(pipeline, plant, 400, seen);
  EXPECT_EQ(seen.estimates.size(), 2U);
  EXPECT_TRUE(seen.alarms.empty());
  run(pipeline, plant, 200, seen);
  EXPECT_EQ(seen.alarms.size(), 1U);
}

TEST(Pipeline, KeepsBatchWindowsOnTheGridOfTicksAcrossAGap) {
  Pipeline pipeline(watched("batch"), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 250, seen);
  for (int i = 0; i < 7; ++i) plant.next();
  run(pipeline, plant, 343, seen);
  ASSERT_EQ(seen.estimates.size(), 3U);
  EXPECT_EQ(seen.estimates[1].tick, 399);
  EXPECT_EQ(seen.estimates[2].tick, 599);
}

TEST(Pipeline, IncrementsWithoutAPoleGiveTheSameGain) {
  PipelineConfig config = watched("sliding");
  config.estimators[0].structure = "arx011";
  config.estimators[0].increments = true;
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  Recorder seen;
  run(pipeline, plant, 600, seen);
  EXPECT_NEAR(seen.estimates.back().b1, kGain_m_per_V, 1e-9 * kGain_m_per_V);
}

TEST(Pipeline, DetrendsEachWindowBeforeItsBatch) {
  PipelineConfig config = watched("batch");
  config.estimators[0].detrend = "mean";
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  Recorder seen;
  for (int i = 0; i < 600; ++i) {
    config::signals::Sample s = plant.next();
    s.y_m += 5.0;  // an offset that would drown the motion
    pipeline.process(s, seen);
  }
  EXPECT_NEAR(seen.estimates.back().b1, kGain_m_per_V, 1e-4 * kGain_m_per_V);
}

TEST(Pipeline, WatchesSampleQuantities) {
  PipelineConfig config;
  BandConfig band;
  band.id = "following";
  band.quantity = "sample.following_error_m";
  band.low = -0.01;
  band.high = 0.01;
  band.on_delay_s = 0.02;
  config.bands.push_back(band);
  Pipeline pipeline(config, kSampleTime_s);
  Recorder seen;
  config::signals::Sample s;
  for (int i = 0; i < 10; ++i, ++s.tick) {
    s.reference_m = i < 3 ? 0.0 : 0.02;
    pipeline.process(s, seen);
  }
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].tick, 7);  // outside since tick 3, 4 ticks make 0.02 s
  EXPECT_EQ(seen.alarms[0].source, "sample");
  EXPECT_EQ(seen.alarms[0].direction, 1);
}

TEST(Pipeline, StartsAgainWhenTheTicksGoBack) {
  Pipeline pipeline(watched("batch"), kSampleTime_s);
  Recorder seen;
  for (int start = 0; start < 2; ++start) {
    Integrator plant;
    run(pipeline, plant, 250, seen);
  }
  ASSERT_EQ(seen.estimates.size(), 2U);
  EXPECT_TRUE(seen.estimates[1].valid);
  EXPECT_NEAR(seen.estimates[1].b1, kGain_m_per_V, 1e-3 * kGain_m_per_V);
}

TEST(Pipeline, ResetForgetsSamplesAndAlarms) {
  Pipeline pipeline(watched("batch"), kSampleTime_s);
  Integrator plant;
  plant.gain_m_per_V = 3e-4;
  Recorder seen;
  run(pipeline, plant, 250, seen);
  EXPECT_EQ(pipeline.alarms().active_count(), 1U);
  pipeline.reset();
  EXPECT_EQ(pipeline.alarms().active_count(), 0U);
  run(pipeline, plant, 200, seen);
  EXPECT_EQ(seen.alarms.size(), 2U);
}

void expect_refused(const PipelineConfig& config, const std::string& part) {
  try {
    const Pipeline pipeline(config, kSampleTime_s);
    FAIL() << "not refused: " << part;
  } catch (const config::schema::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Pipeline, RefusesWhatCannotBeMeant) {
  PipelineConfig config = watched("sliding");
  config.bands[0].quantity = "e.b2";
  expect_refused(config, "e estimates no b2");
  config.bands[0].quantity = "f.b1";
  expect_refused(config, "names no estimator");
  config.bands[0].quantity = "sample.z";
  expect_refused(config, "a sample has no z");
  config = watched("sliding");
  config.bands[0].low = 3e-4;
  expect_refused(config, "is not below high");
  config = watched("sliding");
  config.bands[0].hysteresis = 1.0;
  expect_refused(config, "hysteresis");
  config = watched("sliding");
  config.bands.push_back(config.bands[0]);
  expect_refused(config, "is taken");
  config = watched("sliding");
  config.estimators.push_back(config.estimators[0]);
  expect_refused(config, "[[estimator]] id");
  config = watched("sliding");
  config.estimators[0].structure = "arma";
  expect_refused(config, "[[estimator]] e");
  config = watched("sliding");
  config.estimators[0].detrend = "mean";
  expect_refused(config, "detrend");
  config = watched("sliding");
  config.estimators[0].filter = "low";
  config.estimators[0].filter_high_Hz = 200.0;
  expect_refused(config, "[[estimator]] e");
  config = watched("sliding");
  config.bands[0].low = -std::numeric_limits<double>::infinity();
  config.bands[0].high = std::numeric_limits<double>::infinity();
  expect_refused(config, "neither low nor high");
}

}  // namespace
}  // namespace estimator::fdi
