#include "workbench/promotion/trial.h"

#include <gtest/gtest.h>

#include <limits>

namespace workbench::promotion {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

estimator::fdi::BandConfig band(const char* id, const char* quantity) {
  estimator::fdi::BandConfig band;
  band.id = id;
  band.quantity = quantity;
  return band;
}

/// An alarm that was INVALID all the time.
replay::Occurrence invalid(const char* alarm, double from_s, double to_s) {
  replay::Occurrence occurrence;
  occurrence.alarm = alarm;
  occurrence.from_s = from_s;
  occurrence.to_s = to_s;
  return occurrence;
}

TEST(BandsToLearn, AreThoseOnEstimatesWithoutLimits) {
  estimator::fdi::PipelineConfig rules;
  rules.bands = {band("gain", "sliding.b1"), band("far", "sample.y_m"), band("pole", "sliding.a1")};
  rules.bands.back().high = 1.0;
  const auto bands = bands_to_learn(rules);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_EQ(bands[0].id, "gain");
}

class HasJudged : public testing::Test {
 protected:
  HasJudged() {
    run_.from_s = 100.0;
    run_.to_s = 200.0;
  }
  [[nodiscard]] bool judged() const { return has_judged(run_, {band("gain", "sliding.b1")}); }

  replay::BacktestRun run_;
};

TEST_F(HasJudged, WhereEachLearnedBandIsValidForHalfOfTheRun) {
  EXPECT_TRUE(judged());
  run_.after = {invalid("sliding.gain", 100.0, 120.0), invalid("sliding.gain", 150.0, 180.0)};
  EXPECT_TRUE(judged()) << "just half of it";
  run_.after.push_back(invalid("sliding.gain", 199.0, kNaN));
  EXPECT_FALSE(judged()) << "INVALID also at the end";
}

TEST_F(HasJudged, ThoughAnEstimateOfOtherBandsIsNeverExcited) {
  run_.after = {invalid("period.gain", 100.0, kNaN), invalid("sliding.pole", 100.0, kNaN),
                invalid("voter", 100.0, kNaN)};
  EXPECT_TRUE(judged());
}

TEST_F(HasJudged, AlsoABandWhoseLimitWasPassedAfterItWasInvalid) {
  run_.after = {invalid("sliding.gain", 100.0, kNaN)};
  run_.after[0].limit_s = 101.0;
  EXPECT_TRUE(judged());
}

}  // namespace
}  // namespace workbench::promotion
