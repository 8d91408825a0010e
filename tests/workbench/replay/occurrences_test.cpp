// Two lists of alarms compared: what appears, disappears, shifts, stays.
#include "workbench/replay/occurrences.h"

#include <gtest/gtest.h>

#include <cmath>

namespace workbench::replay {
namespace {

constexpr double kSample_s = 0.0025;

Occurrence at(const char* alarm, double from_s, double to_s, int direction = 1) {
  Occurrence o;
  o.alarm = alarm;
  o.from_s = from_s;
  o.to_s = to_s;
  o.severity = 2;
  o.direction = direction;
  return o;
}

TEST(Occurrences, AreFromTheComingToTheGoingOfAnAlarm) {
  OccurrenceList list;
  list.tell("a", 1.0, true, 2, 1);
  list.tell("b", 1.5, false, 0, 0);  // never came
  list.tell("a", 2.0, true, 3, 0);   // still
  list.tell("a", 3.0, false, 0, 0);
  list.tell("a", 4.0, true, 2, -1);
  ASSERT_EQ(list.all().size(), 2U);
  EXPECT_EQ(list.all()[0].from_s, 1.0);
  EXPECT_EQ(list.all()[0].to_s, 3.0);
  EXPECT_EQ(list.all()[0].severity, 2);
  EXPECT_TRUE(std::isnan(list.all()[1].to_s));
}

TEST(Occurrences, InWhichALimitWasPassedBeginThere) {
  OccurrenceList list;
  list.tell("a", 1.0, true, 3, 0);  // INVALID all the time
  list.tell("a", 2.0, false, 0, 0);
  list.tell("a", 3.0, true, 3, 0);
  list.tell("a", 4.0, true, 2, 1);
  list.tell("a", 5.0, true, 1, 1);
  list.tell("b", 6.0, true, 1, 1);
  const std::vector<Occurrence> passed = passed_limits(list.all());
  ASSERT_EQ(passed.size(), 2U);
  EXPECT_EQ(passed[0].from_s, 4.0);
  EXPECT_TRUE(std::isnan(passed[0].to_s));
  EXPECT_EQ(passed[1].from_s, 6.0);
}

TEST(Occurrences, OfTheSameTimesStayTheSame) {
  const std::vector<Occurrence> list = {at("a", 1, 2), at("b", 1, 2), at("a", 100, NAN)};
  const OccurrenceDifference d = compare(list, list, 10.0, kSample_s);
  EXPECT_EQ(d.same, 3);
  EXPECT_TRUE(d.appears.empty() && d.disappears.empty() && d.shifts.empty());
}

TEST(Occurrences, AppearDisappearAndShift) {
  const std::vector<Occurrence> before = {at("a", 10, 20), at("a", 100, 110), at("b", 5, 6)};
  const std::vector<Occurrence> after = {at("a", 12, 20), at("a", 200, 201), at("c", 5, 6)};
  const OccurrenceDifference d = compare(before, after, 10.0, kSample_s);
  ASSERT_EQ(d.shifts.size(), 1U);
  EXPECT_EQ(d.shifts[0].after.from_s - d.shifts[0].before.from_s, 2.0);
  ASSERT_EQ(d.disappears.size(), 2U);
  EXPECT_EQ(d.disappears[0].from_s, 100.0);
  EXPECT_EQ(d.disappears[1].alarm, "b");
  ASSERT_EQ(d.appears.size(), 2U);
  EXPECT_EQ(d.appears[0].from_s, 200.0);
  EXPECT_EQ(d.appears[1].alarm, "c");
  EXPECT_EQ(d.same, 0);
}

TEST(Occurrences, ThatOverlapAreTheSameOneHoweverFarTheirBeginnings) {
  const OccurrenceDifference d =
      compare({at("a", 0, 100)}, {at("a", 50, 100), at("a", 101, 102)}, 10.0, kSample_s);
  EXPECT_EQ(d.shifts.size(), 1U);
  EXPECT_EQ(d.appears.size(), 1U);
}

TEST(Occurrences, OfAnotherDirectionAreNotTheSame) {
  const OccurrenceDifference d = compare({at("a", 1, 2)}, {at("a", 1, 2, -1)}, 10.0, kSample_s);
  EXPECT_EQ(d.same, 0);
  EXPECT_EQ(d.shifts.size(), 1U);
}

TEST(Occurrences, MatchTheNearestAndEachOnce) {
  const OccurrenceDifference d =
      compare({at("a", 10, 11), at("a", 14, 15)}, {at("a", 13, 15)}, 10.0, kSample_s);
  EXPECT_EQ(d.shifts.size(), 1U);
  EXPECT_EQ(d.disappears.size(), 1U);
}

}  // namespace
}  // namespace workbench::replay
