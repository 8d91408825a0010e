// Which samples are fitted and which score; expected masks counted by hand.
#include "estimator/greybox/fit_dataset.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "config/schema/error.h"

namespace estimator::greybox {

namespace {

/// White noise of 3 um about a slow motion, 200 Hz, settled half a second after each start.
Dataset record(std::size_t samples, double noise_m = 3e-6, unsigned seed = 1,
               std::vector<std::size_t> starts = {0}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_m);
  Dataset m;
  m.name = "made";
  m.sample_time_s = 0.005;
  m.valid.assign(samples, 1);
  for (std::size_t k = 0; k < samples; ++k) {
    m.t_s.push_back(7.0 + static_cast<double>(k) / 200.0);
    m.u_V.push_back(0.1);
    m.y_m.push_back(0.3 + 0.01 * std::sin(m.t_s.back()) + noise(random));
  }
  for (const std::size_t start : starts) {
    for (std::size_t k = start; k < std::min(samples, start + 100); ++k) m.valid[k] = 0;
  }
  m.starts = std::move(starts);
  return m;
}

TEST(FitDataset, FitsEveryOtherBlockOfTwoSecondsAndScoresTheRest) {
  const FitDataset e = fit_dataset({record(2000)}, {});
  ASSERT_EQ(e.size(), 2000);
  for (Eigen::Index k = 0; k < e.size(); ++k) {
    const bool settling = k < 100;
    const bool fitted = (k / 400) % 2 == 0;
    EXPECT_EQ(e.training_mask[k], !settling && fitted ? 1.0 : 0.0) << k;
    EXPECT_EQ(e.validation_mask[k], !settling && !fitted ? 1.0 : 0.0) << k;
  }
  EXPECT_EQ(e.training_mask.sum(), 1100.0);
  EXPECT_EQ(e.validation_mask.sum(), 800.0);
  EXPECT_EQ(e.all_mask.sum(), 1900.0);
  EXPECT_FALSE(e.has_holdouts());
  EXPECT_EQ(e.final_weights().sum(), 1900.0);
}

TEST(FitDataset, CountsNothingWhileASegmentSettles) {
  const FitDataset e = fit_dataset({record(2000, 3e-6, 1, {0, 1000})}, {});
  EXPECT_EQ(e.all_mask.segment(1000, 100).sum(), 0.0);
  EXPECT_EQ(e.all_mask[1100], 1.0);
  EXPECT_EQ(e.all_mask.sum(), 1800.0);
}

TEST(FitDataset, BeginsItsBlocksAnewInEachRecord) {
  const FitDataset e = fit_dataset({record(1600), record(2000)}, {});
  EXPECT_THAT(e.starts, testing::ElementsAre(0U, 1600U));
  EXPECT_EQ(e.validation_mask[1599], 1.0);
  EXPECT_EQ(e.training_mask[1600 + 100], 1.0);
  EXPECT_EQ(e.validation_mask[1600 + 400], 1.0);
  EXPECT_EQ(e.training_mask[1600 + 800], 1.0);
}

TEST(FitDataset, CutsAShortRecordIntoFourBlocks) {
  const FitDataset e = fit_dataset({record(500)}, {});
  EXPECT_EQ(e.training_mask[124], 1.0);
  EXPECT_EQ(e.validation_mask[126], 1.0);
  EXPECT_EQ(e.training_mask[251], 1.0);
  EXPECT_EQ(e.validation_mask[376], 1.0);
  EXPECT_EQ(e.validation_mask[499], 1.0);
}

TEST(FitDataset, FitsOneHalfAndScoresTheOtherBegunAnew) {
  const Dataset whole = record(2001);
  for (const Split::Kind half : {Split::first_half, Split::second_half}) {
    const FitDataset e = fit_dataset({whole}, {}, half);
    ASSERT_EQ(e.records.size(), 2U);
    EXPECT_TRUE(e.has_holdouts());
    const std::size_t fitted_from = half == Split::first_half ? 0 : 1000;
    const std::size_t scored_from = half == Split::first_half ? 1000 : 0;
    EXPECT_EQ(e.records[0].y_m.front(), whole.y_m[fitted_from]);
    EXPECT_EQ(e.records[1].y_m.front(), whole.y_m[scored_from]);
    const auto fitted = static_cast<Eigen::Index>(e.records[0].size());
    EXPECT_EQ(e.training_mask.head(fitted).sum(), e.training_mask.sum());
    EXPECT_EQ(e.validation_mask.head(fitted).sum(), 0.0);
    // the cut is a start whose state is not known
    EXPECT_EQ(e.all_mask.segment(fitted, 100).sum(), 0.0);
    EXPECT_EQ(e.final_weights().sum(), e.training_mask.sum());
  }
}

TEST(FitDataset, FitsEveryOtherBlockOfAStatedLengthEachBegunAnew) {
  const Dataset whole = record(4300);  // 21.5 s: 5 + 5 + 5 + 6.5, the rest too short for a block
  const FitDataset e = fit_dataset({whole}, {}, {Split::blocks, 5.0});
  ASSERT_EQ(e.records.size(), 4U);
  EXPECT_EQ(e.fitted_records, 2U);
  const std::size_t from[] = {0, 2000, 1000, 3000};
  const std::size_t size[] = {1000, 1000, 1000, 1300};
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_EQ(e.records[r].size(), size[r]);
    EXPECT_EQ(e.records[r].y_m.front(), whole.y_m[from[r]]);
    EXPECT_EQ(e.records[r].t_s.front(), whole.t_s[from[r]]);
  }
  const auto fitted = static_cast<Eigen::Index>(e.starts[2]);
  EXPECT_EQ(e.training_mask.tail(e.size() - fitted).sum(), 0.0);
  EXPECT_EQ(e.validation_mask.head(fitted).sum(), 0.0);
  EXPECT_EQ(e.training_mask.sum(), 1800.0);  // half a second of each block settles
  EXPECT_EQ(e.validation_mask.sum(), 2100.0);
  EXPECT_THROW(fit_dataset({whole}, {}, {Split::blocks, 20.0}), config::schema::DataError);
}

TEST(FitDataset, ScoresRecordsThatAreHeldOutAndFitsAllOfTheOthers) {
  const FitDataset e = fit_dataset({record(1000), record(800)}, {record(600)});
  EXPECT_EQ(e.fitted_records, 2U);
  EXPECT_EQ(e.training_mask.sum(), 900.0 + 700.0);
  EXPECT_EQ(e.validation_mask.sum(), 500.0);
  EXPECT_EQ(e.validation_mask.tail(600).sum(), 500.0);
  EXPECT_EQ(e.final_weights().sum(), 1600.0);
}

TEST(FitDataset, HasTheNoiseOfAllRecordsByTheirLength) {
  const double quiet_m = fit_dataset({record(3000, 2e-6, 1)}, {}).noise_floor_m;
  const double loud_m = fit_dataset({record(1000, 6e-6, 2)}, {}).noise_floor_m;
  EXPECT_NEAR(quiet_m, 2e-6, 0.3e-6);
  EXPECT_NEAR(loud_m, 6e-6, 0.9e-6);
  const double both_m =
      fit_dataset({record(3000, 2e-6, 1), record(1000, 6e-6, 2)}, {}).noise_floor_m;
  EXPECT_NEAR(both_m, std::sqrt(0.75 * quiet_m * quiet_m + 0.25 * loud_m * loud_m), 1e-12);
}

TEST(FitDataset, RmsIsOverTheCountedSamplesOnly) {
  Eigen::VectorXd residual_m(4);
  residual_m << 3.0, 100.0, -4.0, 0.0;
  Eigen::VectorXd weights(4);
  weights << 1.0, 0.0, 1.0, 0.0;
  EXPECT_DOUBLE_EQ(rms(residual_m, weights), std::sqrt(12.5));
  EXPECT_EQ(rms(residual_m, Eigen::VectorXd::Zero(4)), 0.0);
}

TEST(Split, IsReadByItsNameAndAnythingElseIsAnError) {
  EXPECT_EQ(parse_split("blocks"), Split::blocks);
  EXPECT_EQ(parse_split("first-half"), Split::first_half);
  EXPECT_EQ(parse_split("second-half"), Split::second_half);
  try {
    static_cast<void>(parse_split("third"));
    FAIL();
  } catch (const config::schema::Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("third"));
    EXPECT_THAT(error.what(), testing::HasSubstr("first-half, second-half"));
  }
  EXPECT_EQ(parse_split("blocks:40"), Split(Split::blocks, 40.0));
  for (const char* text : {"blocks:", "blocks:1.9", "blocks:4x", "blocks:inf", "blocks:-40"}) {
    EXPECT_THROW(static_cast<void>(parse_split(text)), config::schema::UsageError) << text;
  }
}

}  // namespace
}  // namespace estimator::greybox
