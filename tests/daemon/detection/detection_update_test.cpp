// New rules take the place of the old ones between two samples: no sample is lost, and what people
// know of an alarm stays.
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/detection/detector.h"
#include "daemon/rt/loop_runner.h"
#include "estimator/fdi/snapshot.h"
#include "tests/daemon/rt/fake_rig.h"

namespace monitor::detection {
namespace {

namespace fdi = estimator::fdi;
using namespace rt;

/// A band on the position, which the samples put at 0.3 m.
fdi::PipelineConfig rules(double high_m, bool latch, const char* id = "far_out") {
  fdi::PipelineConfig config;
  fdi::EstimatorConfig estimator;
  estimator.id = "gain";
  estimator.method = "sliding";
  estimator.window_s = 0.5;
  config.estimators.push_back(estimator);
  fdi::BandConfig band;
  band.id = id;
  band.quantity = "sample.y_m";
  band.high = high_m;
  band.rules.latch = latch;
  band.rules.shelve_limit_s = 1000.0;
  config.bands.push_back(band);
  return config;
}

struct Bench {
  explicit Bench(Clock& clock_, const fdi::PipelineConfig& config)
      : clock(clock_),
        pipeline(config, kFakeSampleTime_s),
        publisher({"", "TEST"}, 1, kFakeSampleTime_s, nullptr),
        detector({clock,
                  samples,
                  stats,
                  pipeline,
                  publisher,
                  nullptr,
                  {},
                  {&to_detector, &from_detector}},
                 {"", "old", "", "rod", "v", {}, {}, {}}) {}

  void feed(int count, double y_m) {
    for (int i = 0; i < count; ++i) {
      config::signals::Sample sample;
      sample.tick = tick++;
      sample.y_m = y_m;
      sample.u_applied_V = std::sin(0.1 * static_cast<double>(sample.tick));
      samples.push(sample);
    }
  }
  std::shared_ptr<DetectionUpdate> change(const fdi::PipelineConfig& config) {
    auto change = std::make_shared<DetectionUpdate>();
    change->pipeline = std::make_unique<fdi::Pipeline>(config, kFakeSampleTime_s);
    for (const auto& estimator : config.estimators) change->estimators.push_back(estimator.id);
    to_detector.push(change);
    detector.poll();
    std::shared_ptr<DetectionUpdate> taken;
    EXPECT_TRUE(from_detector.pop(taken));
    return taken;
  }
  const fdi::Alarm& alarm(const char* id) {
    const std::size_t number = pipeline.alarms().find(id);
    EXPECT_NE(number, fdi::AlarmBook::kNone) << id;
    return pipeline.alarms().alarm(number);
  }

  Clock& clock;
  SampleQueue samples;
  LoopStats stats;
  DetectionUpdateQueue to_detector, from_detector;
  fdi::Pipeline pipeline;
  io::Publisher publisher;
  Detector detector;
  std::int64_t tick = 0;
};

TEST(DetectionUpdate, KeepsALatchedAlarmWhoseThresholdHasChanged) {
  VirtualClock clock;
  Bench bench(clock, rules(0.2, true));
  bench.feed(10, 0.3);
  bench.detector.poll();
  bench.feed(10, 0.1);
  bench.detector.poll();
  ASSERT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::latched);
  const auto taken = bench.change(rules(0.5, true));
  EXPECT_EQ(taken->warm, std::vector<std::string>{"gain"});
  EXPECT_TRUE(taken->ended.empty());
  EXPECT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::latched);
  EXPECT_EQ(bench.alarm("sample.far_out").high, 0.5);
  EXPECT_EQ(bench.alarm("sample.far_out").times, 1);
  bench.feed(10, 0.3);  // inside the new limits
  bench.detector.poll();
  EXPECT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::latched);
  bench.pipeline.alarms().acknowledge(bench.pipeline.alarms().find("far_out"), "ann");
  EXPECT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::normal);
  bench.feed(1, 0.6);  // outside the new ones
  bench.detector.poll();
  EXPECT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::unacknowledged);
}

TEST(DetectionUpdate, KeepsWhatPeopleDidAndConditionsFromElsewhere) {
  VirtualClock clock;
  Bench bench(clock, rules(0.2, false));
  bench.feed(10, 0.3);
  bench.detector.poll();
  fdi::AlarmBook& book = bench.pipeline.alarms();
  book.set_condition("recorder", "disk_full", fdi::Severity::minor, true, "full", bench.tick);
  book.acknowledge(book.find("sample.far_out"), "ann");
  book.shelve(book.find("sample.far_out"), 600.0, "ann");
  (void)bench.change(rules(0.25, false));
  EXPECT_EQ(bench.alarm("sample.far_out").state(), fdi::AlarmState::shelved);
  EXPECT_EQ(bench.alarm("sample.far_out").acknowledged_by, "ann");
  EXPECT_NEAR(bench.pipeline.alarms().shelved_for_s(bench.alarm("sample.far_out")), 600.0, 0.1);
  EXPECT_EQ(bench.alarm("recorder.disk_full").state(), fdi::AlarmState::unacknowledged);
  EXPECT_EQ(bench.alarm("recorder.disk_full").reason, "full");
}

TEST(DetectionUpdate, EndsAnAlarmThatIsNoLongerThereAndSaysSo) {
  VirtualClock clock;
  Bench bench(clock, rules(0.2, true));
  bench.feed(10, 0.3);
  bench.detector.poll();
  const auto taken = bench.change(rules(0.2, true, "other"));
  EXPECT_EQ(taken->ended, std::vector<std::string>{"sample.far_out"});
  EXPECT_EQ(taken->tick, 9);
  bench.feed(1, 0.3);
  bench.detector.poll();
  EXPECT_EQ(bench.alarm("sample.other").state(), fdi::AlarmState::unacknowledged);
}

TEST(DetectionUpdate, WarmsUpAnEstimatorWithOtherSettings) {
  VirtualClock clock;
  Bench bench(clock, rules(0.5, false));
  bench.feed(200, 0.3);
  bench.detector.poll();
  fdi::PipelineConfig other = rules(0.5, false);
  other.estimators[0].window_s = 0.25;
  const auto taken = bench.change(other);
  EXPECT_TRUE(taken->warm.empty());
  EXPECT_EQ(taken->cold, std::vector<std::string>{"gain"});
}

/// Estimates as text, every digit.
class Estimates final : public fdi::Events {
 public:
  void on_estimate(const fdi::EstimateEvent& event) override {
    char line[64];
    for (const fdi::EstimatedValue& value : event) {
      std::snprintf(line, sizeof line, "%lld %a\n", static_cast<long long>(event.tick),
                    value.value);
      text += line;
    }
  }
  void on_alarm(const fdi::Alarm& alarm) override { text += alarm.reason + '\n'; }
  std::string text;
};

TEST(DetectionUpdate, ToTheSameRulesChangesNoBitOfWhatFollows) {
  const fdi::PipelineConfig config = rules(0.301, false);
  fdi::Pipeline whole(config, kFakeSampleTime_s);
  auto parted = std::make_unique<fdi::Pipeline>(config, kFakeSampleTime_s);
  Estimates one;
  Estimates other;
  double y_m = 0.3;
  for (std::int64_t tick = 0; tick < 1000; ++tick) {
    if (tick == 333) {
      auto next = std::make_unique<fdi::Pipeline>(config, kFakeSampleTime_s);
      EXPECT_EQ(next->inherit(*parted), std::vector<bool>{true});
      parted = std::move(next);
    }
    config::signals::Sample sample;
    sample.tick = tick;
    sample.u_applied_V = std::sin(0.07 * static_cast<double>(tick));
    sample.y_m = y_m;
    y_m += 1e-4 * sample.u_applied_V;
    whole.process(sample, one);
    parted->process(sample, other);
  }
  ASSERT_GT(one.text.size(), 1000U);
  EXPECT_EQ(one.text, other.text);
}

TEST(DetectionUpdate, LosesNoSampleOfALoopInRealTime) {
  MonotonicClock clock;
  const fdi::PipelineConfig a = rules(0.2, true);
  const fdi::PipelineConfig b = rules(0.25, true);
  Bench bench(clock, a);
  FakeRig rig{nullptr};
  rig.writes.reserve(100000);
  CommandQueue commands;
  control::Sine reference(0.3, 0.0, 0.0);
  Loop loop({}, {clock, rig, &rig, reference, bench.samples, commands, bench.stats},
            control::Controller({100.0}, {kFakeNull_V, 30.0}, kFakeSampleTime_s), kFakeSampleTime_s,
            without_blending());
  std::atomic<bool> stop{false};
  int handed = 0;
  int taken = 0;
  {
    rt::LoopRunner runner(loop, Grid(clock.now_ns(), 1'000'000), clock, &rig, kForever, stop);
    EXPECT_EQ(run_realtime(runner, bench.detector, {}, stop, &rig,
                           [&] {
                             std::shared_ptr<DetectionUpdate> back;
                             while (bench.from_detector.pop(back)) ++taken;
                             if (handed < 20 && handed == taken) {
                               auto next = std::make_shared<DetectionUpdate>();
                               next->pipeline = std::make_unique<fdi::Pipeline>(
                                   handed % 2 == 0 ? b : a, kFakeSampleTime_s);
                               next->estimators = {"gain"};
                               bench.to_detector.push(std::move(next));
                               ++handed;
                             }
                             clock.sleep_until_ns(clock.now_ns() + 5'000'000);
                             return taken == 20;
                           }),
              "");
  }
  EXPECT_EQ(taken, 20);
  EXPECT_EQ(bench.stats.dropped_samples.value(), 0);
  EXPECT_EQ(bench.stats.detected_samples.value(), bench.stats.ticks.value());
  EXPECT_GT(bench.stats.ticks.value(), 20);
}

}  // namespace
}  // namespace monitor::detection
