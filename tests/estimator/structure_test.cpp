#include "estimator/structure.h"

#include <gmock/gmock.h>

#include "config/schema/error.h"
#include "estimator/regressor.h"

namespace estimator {
namespace {

using testing::ElementsAre;

TEST(Structure, ReadsTheShortAndTheLongForm) {
  EXPECT_EQ(parse_structure("arx211"), (Structure{2, 1, 1, false}));
  EXPECT_EQ(parse_structure("ARX441", true), (Structure{4, 4, 1, true}));
  EXPECT_EQ(parse_structure("arx(10,2,1)"), (Structure{10, 2, 1, false}));
  EXPECT_EQ(parse_structure("Arx(3, 2, 25)"), (Structure{3, 2, 25, false}));
}

TEST(Structure, PrintsWhatItReads) {
  EXPECT_EQ((Structure{2, 1, 1, false}.text()), "arx211");
  EXPECT_EQ((Structure{10, 2, 1, false}.text()), "arx(10,2,1)");
  EXPECT_EQ(parse_structure(Structure{9, 10, 50, false}.text()), (Structure{9, 10, 50, false}));
}

TEST(Structure, NamesItsCoefficientsInTheirOrder) {
  EXPECT_THAT((Structure{2, 2, 1, true}.names()), ElementsAre("a1", "a2", "b1", "b2", "constant"));
}

TEST(Structure, RefusesWhatItDoesNotKnow) {
  for (const char* bad :
       {"", "arx", "arx21", "arx2111", "armax211", "arx(11,1,1)", "arx(1,1,51)", "arx001",
        "arx(1,1)", "arx(1,1,1", "arx(1,1,1)x", "arx(1,,1)", "arx(-1,1,1)", "arx(1,1,1,1)"}) {
    try {
      (void)parse_structure(bad);
      FAIL() << bad;
    } catch (const config::schema::UsageError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("arx(N,M,K)"));
    }
  }
}

/// u(t) = 100 + t, y(t) = t
bool push_ramp(Regressor& regressor, int t) { return regressor.push(100.0 + t, t); }

TEST(Regressor, PutsPastOutputsNegatedAndDelayedInputsInOrder) {
  Regressor regressor({2, 3, 2, true});
  int first = -1;
  for (int t = 0; t < 200; ++t) {  // several times around the history's memory
    const bool ready = push_ramp(regressor, t);
    if (ready && first < 0) first = t;
    if (!ready) continue;
    const std::vector<double> row(regressor.row(), regressor.row() + regressor.size());
    ASSERT_THAT(row, ElementsAre(1.0 - t, 2.0 - t, 98.0 + t, 97.0 + t, 96.0 + t, 1.0));
    ASSERT_EQ(regressor.target_m(), t);
  }
  EXPECT_EQ(first, 4);  // u(t - k - m + 1) = u(0)
}

TEST(Regressor, AllowsNoDelayAndTheLongest) {
  Regressor direct({1, 1, 0, false});
  EXPECT_FALSE(push_ramp(direct, 0));
  ASSERT_TRUE(push_ramp(direct, 1));
  EXPECT_EQ(direct.row()[1], 101.0);

  Regressor longest({10, 10, 50, false});
  for (int t = 0; t < 59; ++t) ASSERT_FALSE(push_ramp(longest, t)) << t;
  for (int t = 59; t < 300; ++t) {
    ASSERT_TRUE(push_ramp(longest, t));
    ASSERT_EQ(longest.row()[9], 10.0 - t);
    ASSERT_EQ(longest.row()[10], 100.0 + t - 50);
    ASSERT_EQ(longest.row()[19], 100.0 + t - 59);
  }
}

TEST(Regressor, DropsEveryRowThatReachesAcrossAGapOrAMissingValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Regressor regressor({3, 1, 1, false});
  const auto count = [&](int from, int to) {
    int rows = 0;
    for (int t = from; t < to; ++t) rows += push_ramp(regressor, t) ? 1 : 0;
    return rows;
  };
  EXPECT_EQ(count(0, 10), 7);
  regressor.reset();
  EXPECT_EQ(count(15, 25), 7);
  EXPECT_FALSE(regressor.push(nan, 25.0));
  EXPECT_EQ(count(26, 36), 7);
  EXPECT_FALSE(regressor.push(1.0, infinity));
  EXPECT_EQ(count(37, 47), 7);
}

}  // namespace
}  // namespace estimator
