// A sine with readings that leap by hand.
#include "workbench/diagnose/leaps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "workbench/fit/ignored_spans.h"

namespace workbench::diagnose {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTs = 0.005;

/// 20 s; `every` nth sample leaps by 20 mm.
config::record::Record record(std::size_t every) {
  config::record::Record made;
  made.name = "made.csv";
  made.sample_time_s = kTs;
  for (std::size_t k = 0; k < 4000; ++k) {
    const double t_s = kTs * static_cast<double>(k);
    made.t_s.push_back(t_s);
    made.u_V.push_back(std::cos(3.0 * t_s));
    made.y_m.push_back(0.3 + 0.1 * std::sin(3.0 * t_s) + (k % every == every - 1 ? 0.02 : 0.0));
  }
  return made;
}

TEST(Leaps, AreGapsThatANoteNames) {
  const estimator::greybox::Dataset data = dataset_without_leaps(record(1500));
  EXPECT_EQ(data.size(), 4000U - 2U);
  EXPECT_THAT(data.starts, ElementsAre(0U, 1499U, 2998U));
  ASSERT_FALSE(data.notes.empty());
  EXPECT_THAT(data.notes.back(), HasSubstr("2 samples of the position leap"));
  EXPECT_THAT(data.notes.back(), HasSubstr("at 7.495 s"));
}

/// The sine alone, with samples that leap by 20 mm.
config::record::Record leaping(const std::vector<std::size_t>& samples) {
  config::record::Record made = record(100000);
  for (const std::size_t k : samples) made.y_m[k] += 0.02;
  return made;
}

TEST(Leaps, OfTwoSamplesAreOneGap) {
  const estimator::greybox::Dataset data = dataset_without_leaps(leaping({1499, 1500}));
  EXPECT_EQ(data.size(), 4000U - 2U);
  EXPECT_THAT(data.starts, ElementsAre(0U, 1499U));
  ASSERT_FALSE(data.notes.empty());
  EXPECT_THAT(data.notes.back(), HasSubstr("2 samples of the position leap"));
}

// The samples left between leap and gap are too few for a segment.
TEST(Leaps, BesideAGapTakeTheRestOfTheSegmentAlong) {
  for (const std::size_t leap : {1497U, 1502U}) {
    config::record::Record made = leaping({leap});
    made.gaps = {1500};
    const estimator::greybox::Dataset data = dataset_without_leaps(made);
    EXPECT_EQ(data.size(), 4000U - 3U) << leap;
    ASSERT_THAT(data.starts, testing::SizeIs(2)) << leap;
    EXPECT_EQ(data.t_s[data.starts[1]], made.t_s[leap < 1500 ? 1500 : 1503]) << leap;
    ASSERT_FALSE(data.notes.empty());
    EXPECT_THAT(data.notes.back(), HasSubstr("a sample of the position leaps"));
  }
}

TEST(Leaps, AtTheEdgeOfAGapAreNotLookedAt) {
  config::record::Record made = leaping({1499, 1500});
  made.gaps = {1500};
  const estimator::greybox::Dataset data = dataset_without_leaps(made);
  EXPECT_EQ(data.size(), 4000U);
  EXPECT_THAT(data.notes, testing::IsEmpty());
}

TEST(Leaps, ThatAreIgnoredAlreadyAreNotCountedAgain) {
  std::vector<config::record::Record> records{leaping({1499, 1500, 2999})};
  fit::cut_ignored({"7.4925:7.5975"}, {"made.csv"}, records);
  const estimator::greybox::Dataset data = dataset_without_leaps(records.front());
  EXPECT_EQ(data.size(), 4000U - 21U - 1U);
  EXPECT_THAT(data.starts, ElementsAre(0U, 1499U, 1499U + 2999U - 1520U));
  ASSERT_FALSE(data.notes.empty());
  EXPECT_THAT(data.notes.back(), HasSubstr("a sample of the position leaps"));
  EXPECT_THAT(data.notes.back(), HasSubstr("at 14.995 s"));
}

// A sample that the user ignores splits a leap of two: what is left of it is a segment's edge.
TEST(Leaps, ThatAreIgnoredByHalfLeaveNoSecondGap) {
  std::vector<config::record::Record> records{leaping({1499, 1500})};
  fit::cut_ignored({"7.494:7.496"}, {"made.csv"}, records);
  const estimator::greybox::Dataset data = dataset_without_leaps(records.front());
  EXPECT_EQ(data.size(), 4000U - 1U);
  EXPECT_THAT(data.starts, ElementsAre(0U, 1499U));
}

TEST(Leaps, StayWhereTheGapsWouldTakeMuchOfTheRecord) {
  EXPECT_EQ(dataset_without_leaps(record(300)).size(), 4000U);
}

TEST(Leaps, ARecordWithoutThemStaysAsItIs) {
  const estimator::greybox::Dataset data = dataset_without_leaps(record(100000));
  EXPECT_EQ(data.size(), 4000U);
  EXPECT_THAT(data.notes, testing::IsEmpty());
}

}  // namespace
}  // namespace workbench::diagnose
