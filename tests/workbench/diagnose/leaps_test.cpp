// A sine with readings that leap by hand.
#include "workbench/diagnose/leaps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>

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
