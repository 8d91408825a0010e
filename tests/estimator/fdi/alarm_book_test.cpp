#include "estimator/fdi/alarm_book.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace estimator::fdi {
namespace {

std::vector<std::string> active(const AlarmBook& book) {
  std::vector<std::string> names;
  book.for_each_active([&](const Alarm& alarm) { names.push_back(alarm.name); });
  return names;
}

TEST(AlarmBook, TellsATransitionOnceAndListsTheAlarmUntilItGoes) {
  AlarmBook book;
  EXPECT_EQ(book.set_condition("recorder", "disk_full", Severity::minor, false, "", 1), nullptr);

  const Alarm* came = book.set_condition("recorder", "disk_full", Severity::minor, true, "full", 7);
  ASSERT_NE(came, nullptr);
  EXPECT_EQ(came->source, "recorder");
  EXPECT_EQ(came->severity, Severity::minor);
  EXPECT_EQ(came->tick, 7);
  EXPECT_EQ(came->reason, "full");
  EXPECT_TRUE(came->active);
  EXPECT_EQ(book.set_condition("recorder", "disk_full", Severity::minor, true, "full", 8), nullptr);
  EXPECT_EQ(active(book), std::vector<std::string>{"disk_full"});

  const Alarm* went = book.set_condition("recorder", "disk_full", Severity::minor, false, "", 9);
  ASSERT_NE(went, nullptr);
  EXPECT_FALSE(went->active);
  EXPECT_EQ(went->tick, 9);
  EXPECT_TRUE(active(book).empty());
  EXPECT_EQ(book.active_count(), 0U);
}

TEST(AlarmBook, KeepsConditionsOfTheSameNameFromTwoSourcesApart) {
  AlarmBook book;
  book.set_condition("loop", "overrun", Severity::major, true, "", 1);
  EXPECT_NE(book.set_condition("device", "overrun", Severity::minor, true, "", 1), nullptr);
  EXPECT_EQ(book.active_count(), 2U);
}

TEST(AlarmBook, MarksTheFirstOfSeveralAlarms) {
  AlarmBook book;
  EXPECT_TRUE(book.set_condition("a", "x", Severity::major, true, "", 1)->first_up);
  EXPECT_FALSE(book.set_condition("b", "y", Severity::major, true, "", 2)->first_up);
}

TEST(AlarmBook, TakesAChangeOfSeverityOrDirectionForATransition) {
  AlarmBook book;
  const std::size_t number = book.declare({});
  AlarmInput input;
  input.severity = Severity::major;
  input.direction = 1;
  EXPECT_NE(book.set(number, input), nullptr);
  input.value = 5.0;
  EXPECT_EQ(book.set(number, input), nullptr);
  EXPECT_EQ(book.alarm(number).value, 5.0);
  input.direction = -1;
  EXPECT_NE(book.set(number, input), nullptr);
  input.severity = Severity::invalid;
  EXPECT_NE(book.set(number, input), nullptr);
  EXPECT_EQ(book.active_count(), 1U);
}

}  // namespace
}  // namespace estimator::fdi
