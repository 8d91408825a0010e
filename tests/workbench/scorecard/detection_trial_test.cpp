// Alarms against what was injected, on a signal whose course is known.
#include "workbench/scorecard/detection_trial.h"

#include <gmock/gmock.h>

#include <cmath>

namespace workbench::scorecard {
namespace {

namespace fdi = estimator::fdi;

constexpr double kPeriod_s = 0.005;

fdi::BandConfig band(const std::string& id, double high, const std::string& parameter,
                     const std::vector<std::string>& group = {}) {
  fdi::BandConfig out;
  out.id = id;
  out.quantity = "sample.y_m";
  out.high = high;
  out.parameter = parameter;
  out.ambiguity_group = group;
  out.rules.chatter_count = 0;
  return out;
}

fdi::PipelineConfig watching(const std::vector<fdi::BandConfig>& bands) {
  fdi::PipelineConfig config;
  config.bands = bands;
  return config;
}

/// y rises by 1 m/s from `from_s` on.
Samples ramp(double from_s, double duration_s) {
  Samples samples(static_cast<std::size_t>(std::lround(duration_s / kPeriod_s)));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double t_s = static_cast<double>(k) * kPeriod_s;
    samples[k].tick = static_cast<std::int64_t>(k);
    samples[k].y_m = std::max(0.0, t_s - from_s);
  }
  return samples;
}

TrialAnswer answer(const std::vector<fdi::BandConfig>& bands, double fault_s = 1.0) {
  return DetectionTrial(watching(bands), kPeriod_s).fault(ramp(1.0, 4.0), fault_s, {"a"}, true);
}

TEST(DetectionTrial, MeasuresTheDelayFromTheFaultToTheFirstAlarm) {
  const TrialAnswer found = answer({band("one", 0.5, "a")});
  EXPECT_EQ(found.verdict, TrialVerdict::right);
  EXPECT_NEAR(found.delay_s, 0.505, 1e-9);  // the first sample above 0.5 m
  EXPECT_THAT(found.first, testing::ElementsAre("a"));
}

TEST(DetectionTrial, GoesOnFromALeadAsIfItHadTakenIt) {
  const std::vector<fdi::BandConfig> bands{band("one", 0.5, "a", {"a", "b"}),
                                           band("two", 1.5, "c")};
  DetectionTrial watch(watching(bands), kPeriod_s);
  DetectionTrial::Lead lead;
  const Samples slow = ramp(1.2, 4.0);
  const Samples late = ramp(2.0, 4.0);
  const TrialAnswer first = watch.fault(slow, 1.1, {"a"}, true, &lead);
  ASSERT_NE(lead.said, nullptr);
  const TrialAnswer alone =
      DetectionTrial(watching(bands), kPeriod_s).fault(late, 1.1, {"a"}, true);
  const TrialAnswer after = watch.fault(late, 1.1, {"a"}, true, &lead);
  EXPECT_NEAR(first.delay_s, 0.605, 1e-9);
  EXPECT_EQ(first.verdict, TrialVerdict::wrong);
  EXPECT_EQ(after.delay_s, alone.delay_s);
  EXPECT_NEAR(after.delay_s, 1.405, 1e-9);
  EXPECT_EQ(after.verdict, alone.verdict);
  EXPECT_EQ(after.first, alone.first);
}

TEST(DetectionTrial, CountsNoNotice) {
  DetectionTrial watch(watching({band("one", 0.5, "a"), band("two", 0.7, "b")}), kPeriod_s,
                       {"sample.one"});
  const TrialAnswer found = watch.fault(ramp(1.0, 4.0), 1.0, {"b"}, true);
  EXPECT_EQ(found.verdict, TrialVerdict::right);
  EXPECT_NEAR(found.delay_s, 0.705, 1e-9);
}

TEST(DetectionTrial, JudgesTheNamesOfEveryAlarm) {
  EXPECT_EQ(answer({band("one", 0.5, "a", {"a", "b"})}).verdict, TrialVerdict::group);
  EXPECT_EQ(answer({band("one", 0.5, "b")}).verdict, TrialVerdict::wrong);
  EXPECT_EQ(answer({band("one", 0.5, "a"), band("two", 1.5, "b")}).verdict, TrialVerdict::wrong);
  EXPECT_EQ(answer({band("one", 0.5, "a"), band("two", 1.5, "b", {"a", "b"})}).verdict,
            TrialVerdict::group);
  EXPECT_EQ(answer({band("one", 0.5, "")}).verdict, TrialVerdict::unnamed);
  EXPECT_EQ(answer({band("one", 0.5, ""), band("two", 1.0, "a")}).verdict, TrialVerdict::right);
  EXPECT_EQ(answer({band("one", 9.0, "a")}).verdict, TrialVerdict::missed);
  EXPECT_TRUE(std::isinf(answer({band("one", 9.0, "a")}).delay_s));
}

TEST(DetectionTrial, JoinsTheNamesThatComeTogether) {
  EXPECT_THAT(answer({band("one", 0.5, "a"), band("two", 0.5, "b"), band("three", 1.0, "c")}).first,
              testing::ElementsAre("a", "b"));
}

TEST(DetectionTrial, StopsAtTheFirstAlarmWhenTheRestDoesNotCount) {
  DetectionTrial watch(watching({band("one", 0.5, "a"), band("two", 1.0, "b")}), kPeriod_s);
  EXPECT_EQ(watch.fault(ramp(1.0, 4.0), 1.0, {"a"}, false).verdict, TrialVerdict::right);
  EXPECT_EQ(watch.fault(ramp(1.0, 4.0), 1.0, {"a"}, true).verdict, TrialVerdict::wrong);
}

TEST(DetectionTrial, DoesNotCountAnAlarmThatStoodBefore) {
  const TrialAnswer found = answer({band("one", 0.5, "a")}, 2.0);
  EXPECT_EQ(found.verdict, TrialVerdict::standing);
  EXPECT_FALSE(found.detected());
}

TEST(DetectionTrial, CountsTimesAndTimeOfFalseAlarms) {
  Samples samples = ramp(100.0, 10.0);  // ten seconds of 0 m
  for (const std::size_t from : {200U, 800U, 1400U}) {
    for (std::size_t k = from; k < from + 100; ++k) samples[k].y_m = 1.0;
  }
  for (std::size_t k = 1700; k < 1800; ++k) samples[k].y_m = std::nan("");
  DetectionTrial watch(watching({band("one", 0.5, "a"), band("two", 0.9, "b")}), kPeriod_s);
  const Quiet quiet = watch.quiet(samples);
  EXPECT_EQ(quiet.alarms, 3);
  EXPECT_NEAR(quiet.alarm_s, 3 * 100 * kPeriod_s, 1e-9);
  EXPECT_NEAR(quiet.invalid_s, 100 * kPeriod_s, 1e-9);
  EXPECT_EQ(watch.quiet(ramp(100.0, 10.0)).alarms, 0) << "begins anew";
}

}  // namespace
}  // namespace workbench::scorecard
