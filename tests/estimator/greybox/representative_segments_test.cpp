// Which samples of a long record are searched; expected counts and places by hand.
#include "estimator/greybox/representative_segments.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

namespace estimator::greybox {

namespace {

using testing::AllOf;
using testing::Ge;
using testing::Le;
using testing::SizeIs;

constexpr double kSample_s = 0.05;

/// 20 Hz; the rod moves only from `busy_s` on for `busy_for_s` of every minute.
Dataset record(double length_s, double busy_s = 0.0, double busy_for_s = 60.0,
               double sample_time_s = kSample_s) {
  Dataset m;
  m.name = "made";
  m.sample_time_s = sample_time_s;
  const auto samples = static_cast<std::size_t>(std::lround(length_s / sample_time_s));
  double y_m = 0.3;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = static_cast<double>(k) * sample_time_s;
    const double within_s = std::fmod(t_s, 60.0);
    if (within_s >= busy_s && within_s < busy_s + busy_for_s) y_m += 1e-4 * std::cos(t_s);
    m.t_s.push_back(t_s);
    m.u_V.push_back(t_s);
    m.y_m.push_back(y_m);
  }
  m.valid.assign(samples, 1);
  m.starts = {0};
  return m;
}

TEST(Stretches, OfTenMinutesAreOneTenthAndOneFifthOfASlowLog) {
  const std::pair<double, std::size_t> rates[] = {{0.0025, 5}, {0.005, 5}, {0.008, 8}, {0.05, 10}};
  for (const auto& [sample_time_s, segments] : rates) {
    const FitDataset whole = fit_dataset({record(600.0, 0.0, 60.0, sample_time_s)}, {});
    const FitDataset found = representative_segments(whole);
    EXPECT_NEAR(length_s(whole), 600.0, 1e-8);
    EXPECT_NEAR(length_s(found), 12.0 * static_cast<double>(segments), 1e-8);
    EXPECT_THAT(found.records.front().starts, SizeIs(segments));
    EXPECT_EQ(found.least_floor_m, whole.least_floor_m);
  }
}

TEST(Stretches, LieWhereTheRodMovesInEachPartOfTheRecord) {
  const FitDataset found = representative_segments(fit_dataset({record(600.0, 30.0, 15.0)}, {}));
  const Dataset& kept = found.records.front();
  ASSERT_THAT(kept.starts, SizeIs(10));
  for (std::size_t i = 0; i < 10; ++i) {
    const double from_s = kept.t_s[kept.starts[i]] - 60.0 * static_cast<double>(i);
    EXPECT_THAT(from_s, AllOf(Ge(27.0), Le(36.0)));
  }
}

TEST(Stretches, KeepWhatEachSampleIsFor) {
  const FitDataset whole = fit_dataset({record(600.0)}, {});
  const FitDataset found = representative_segments(whole);
  const Dataset& kept = found.records.front();
  double settling = 0.0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const auto there = static_cast<Eigen::Index>(std::lround(kept.t_s[k] / kSample_s));
    const auto here = static_cast<Eigen::Index>(k);
    EXPECT_EQ(kept.y_m[k], whole.records.front().y_m[static_cast<std::size_t>(there)]);
    if (kept.valid[k] == 0) {
      ++settling;
      EXPECT_EQ(found.all_mask[here], 0.0);
      continue;
    }
    EXPECT_EQ(found.training_mask[here], whole.training_mask[there]);
    EXPECT_EQ(found.validation_mask[here], whole.validation_mask[there]);
  }
  EXPECT_EQ(settling, 10 * 10);
  EXPECT_NEAR(found.training_mask.sum(), found.validation_mask.sum(), 100.0);
}

TEST(Stretches, AreTakenOfEveryRecordAndShortOnesStayWhole) {
  const FitDataset whole = fit_dataset({record(500.0), record(15.0)}, {record(85.0)});
  const FitDataset found = representative_segments(whole);
  ASSERT_THAT(found.records, SizeIs(3));
  EXPECT_EQ(found.fitted_records, 2U);
  EXPECT_THAT(found.records[0].starts, SizeIs(8));
  EXPECT_EQ(found.records[1].size(), whole.records[1].size());
  EXPECT_THAT(found.records[2].starts, SizeIs(1));
  EXPECT_THAT(found.starts, testing::ElementsAre(0, 1920, 2220));
  EXPECT_EQ(found.training_mask.tail(240).sum(), 0.0);
  EXPECT_EQ(found.validation_mask.head(2220).sum(), 0.0);
}

TEST(Stretches, BeginAnewAfterGapsOfTheRecord) {
  Dataset gappy = record(600.0);
  gappy.starts = {0, 30, 2430};
  const FitDataset found = representative_segments(fit_dataset({gappy}, {}));
  for (const std::size_t start : found.records.front().starts) {
    EXPECT_LT(start, found.records.front().size());
  }
  EXPECT_GE(found.records.front().starts.size(), 10U);
}

}  // namespace
}  // namespace estimator::greybox
