#include "estimator/greybox/dataset.h"
#include "config/record/record.h"

#include <gmock/gmock.h>

#include <numeric>

#include "config/schema/error.h"

namespace estimator::greybox {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTs = 0.01;

/// Samples numbered by their y; gaps before the given indices.
config::record::Record record(std::size_t samples, std::vector<std::size_t> gaps = {}) {
  config::record::Record r;
  r.name = "made.csv";
  r.sample_time_s = kTs;
  for (std::size_t k = 0; k < samples; ++k) {
    r.t_s.push_back(kTs * static_cast<double>(k));
    r.u_V.push_back(1.0);
    r.y_m.push_back(static_cast<double>(k));
  }
  r.gaps = std::move(gaps);
  return r;
}

TEST(Dataset, HasOneSegmentWhereNothingIsMissing) {
  const Dataset m = dataset_of(record(300));
  EXPECT_EQ(m.size(), 300U);
  EXPECT_THAT(m.starts, ElementsAre(0U));
  EXPECT_EQ(m.gaps.gaps, 0U);
}

TEST(Dataset, DoesNotCountTheFirstHalfSecondOfEachSegment) {
  const Dataset m = dataset_of(record(300, {150}));
  ASSERT_THAT(m.starts, ElementsAre(0U, 150U));
  for (std::size_t k = 0; k < 300; ++k) {
    EXPECT_EQ(m.valid[k] != 0, k % 150 >= 50) << k;
  }
}

TEST(Dataset, LeavesOutShortSegmentsAndSaysSo) {
  const Dataset m = dataset_of(record(500, {200, 299}));  // 0.99 s between the gaps
  EXPECT_THAT(m.starts, ElementsAre(0U, 200U));
  EXPECT_EQ(m.size(), 401U);
  EXPECT_EQ(m.y_m[199], 199.0);
  EXPECT_EQ(m.y_m[200], 299.0);
  EXPECT_EQ(m.gaps.gaps, 2U);
  EXPECT_EQ(m.gaps.segments, 2U);
  EXPECT_EQ(m.gaps.samples_left_out, 99U);
}

TEST(Dataset, RefusesLessThanTwoSecondsOfConnectedSamples) {
  try {
    (void)dataset_of(record(390, {95, 190, 285}));  // four times just under a second
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("too short: of 3.9 s in 4 segments, the longest 1.05 s"));
  }
  try {
    (void)dataset_of(record(150));
    FAIL();
  } catch (const config::schema::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("too short: 1.5 s"));
  }
}

TEST(Dataset, RefusesSamplesFarApart) {
  config::record::Record slow = record(300);
  slow.sample_time_s = 0.6;
  try {
    (void)dataset_of(slow);
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is sampled every 0.6 s; allowed: every 0.5 s or faster"));
  }
}

TEST(Dataset, NamesTheTimeOfASpikeThatNoRigHas) {
  config::record::Record spiked = record(300);
  spiked.y_m[120] = -1e30;
  spiked.y_m[121] = 1e160;
  try {
    (void)dataset_of(spiked);
    FAIL();
  } catch (const config::schema::DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("has a spike at 1.2 s: position -1e+30 m, and 1 more"));
  }
  spiked = record(300);
  spiked.u_V[5] = 1e12;
  EXPECT_THROW((void)dataset_of(spiked), config::schema::DataError);
}

TEST(Dataset, SaysWhySamplesAreMissingWhereTooFewAreLeft) {
  config::record::Record torn = record(390, {95, 190, 285});
  torn.left_out = "-9999 m at 0.95 s (3 samples) marks missing values: they are gaps";
  try {
    (void)dataset_of(torn);
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("; " + torn.left_out + "; allowed: at least 2 s"));
  }
}

TEST(Dataset, GivesAPartWithItsOwnSegmentsAndSettling) {
  const Dataset whole = dataset_of(record(600, {300}));
  const Dataset p = part(whole, 200, 500);
  EXPECT_EQ(p.size(), 300U);
  EXPECT_EQ(p.y_m.front(), 200.0);
  EXPECT_THAT(p.starts, ElementsAre(0U, 100U));
  EXPECT_EQ(std::accumulate(p.valid.begin(), p.valid.end(), 0), 200);
  EXPECT_EQ(p.valid[49], 0);
  EXPECT_EQ(p.valid[50], 1);
}

}  // namespace
}  // namespace estimator::greybox
