// The rules by which a figure counts as reproduced.
#include "workbench/reproduce/tolerance.h"

#include <gmock/gmock.h>

#include <cmath>

namespace workbench::reproduce {
namespace {

TEST(Tolerance, RelativeRuleTakesTheLimitAndNothingBeyond) {
  EXPECT_EQ(judged("E", 100.0, 100.9, "cost, in step").agrees, Agreement::yes);
  EXPECT_EQ(judged("E", 100.0, 101.1, "cost, in step").agrees, Agreement::no);
  EXPECT_EQ(judged("E", 100.0, 98.9, "cost, in step").agrees, Agreement::no);
}

TEST(Tolerance, AboutFivePercentMeansBetweenFourAndAHalfAndFiveAndAHalf) {
  EXPECT_EQ(judged("b1", 5.0, 4.51, "about +5 %").agrees, Agreement::yes);
  EXPECT_EQ(judged("b1", 5.0, 4.49, "about +5 %").agrees, Agreement::no);
  EXPECT_EQ(judged("b1", -5.0, 5.0, "about -5 %").agrees, Agreement::no);
}

TEST(Tolerance, AlarmTimesMayBeOneSampleApart) {
  EXPECT_EQ(judged("alarm", 18.0, 17.995, "alarm time").agrees, Agreement::yes);
  EXPECT_EQ(judged("alarm", 18.0, 18.010, "alarm time").agrees, Agreement::no);
  EXPECT_EQ(judged("alarm", 18.0, 16.0, "alarm time").agrees, Agreement::no);
}

TEST(Tolerance, ValuesThatAreNoNumbersNeverAgree) {
  EXPECT_EQ(judged("alarm", 18.0, std::nan(""), "alarm time").agrees, Agreement::no);
  EXPECT_EQ(judged("E", 1.0, INFINITY, "cost, in step").agrees, Agreement::no);
  EXPECT_EQ(judged("E", 1.0, {}, "cost, in step").agrees, Agreement::no);
  EXPECT_EQ(judged("E", {}, 1.0, "cost, in step").agrees, Agreement::no);
}

TEST(Tolerance, WordsMustBeTheSame) {
  EXPECT_EQ(judged("isolated", std::string("no"), std::string("no"), "words").agrees,
            Agreement::yes);
  EXPECT_EQ(judged("isolated", std::string("no"), std::string("yes"), "words").agrees,
            Agreement::no);
}

TEST(Tolerance, WithoutAPrintedFigureNothingIsJudged) {
  const ReproducedRow row = judged("b1", {}, 1.0, "information");
  EXPECT_EQ(row.agrees, Agreement::not_applicable);
  EXPECT_FALSE(row.expected);
}

}  // namespace
}  // namespace workbench::reproduce
