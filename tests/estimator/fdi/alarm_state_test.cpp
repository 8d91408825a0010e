// The life of an alarm among people: acknowledged, latched, shelved, counted, quieted, first of a
// burst. One tick is one second.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/estimator/fdi/alarm_fixture.h"

namespace estimator::fdi {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(AlarmLife, IsListedUntilSomebodyHasAcknowledgedIt) {
  const std::size_t a = declare("a");
  cause(1, a);
  gone(5, a);
  EXPECT_EQ(book.active_count(), 0U);
  EXPECT_EQ(book.alarm(a).state(), AlarmState::returned);
  pass(6);
  tell(book.acknowledge(a, "ann").changed);
  EXPECT_EQ(book.alarm(a).acknowledged_by, "ann");
  cause(8, a);
  pass(9);
  tell(book.acknowledge(a, "ann").changed);
  EXPECT_EQ(book.active_count(), 1U);
  gone(11, a);
  EXPECT_THAT(told, ElementsAre("1 a UNACKNOWLEDGED", "5 a RETURNED", "6 a NORMAL",
                                "8 a UNACKNOWLEDGED", "9 a ACKNOWLEDGED", "11 a NORMAL"));
  EXPECT_EQ(book.acknowledge(a, "ann").refusal, "nothing to acknowledge");
  EXPECT_EQ(book.alarm(a).times, 2);
}

TEST_F(AlarmLife, WithoutAcknowledgementIsNormalAsSoonAsItsCauseHasGone) {
  AlarmRules rules;
  rules.acknowledge = false;
  const std::size_t a = declare("a", rules);
  cause(1, a);
  gone(5, a);
  EXPECT_THAT(told, ElementsAre("1 a ACKNOWLEDGED", "5 a NORMAL"));
}

TEST_F(AlarmLife, ThatLatchesStaysActiveUntilItIsAcknowledged) {
  AlarmRules rules;
  rules.latch = true;
  const std::size_t a = declare("a", rules);
  cause(1, a);
  gone(5, a);
  EXPECT_TRUE(book.alarm(a).active);
  EXPECT_EQ(book.alarm(a).severity, Severity::major);
  EXPECT_EQ(book.active_count(), 1U);
  cause(7, a);
  gone(8, a);
  pass(9);
  tell(book.acknowledge(a, "ann").changed);
  EXPECT_FALSE(book.alarm(a).active);
  EXPECT_THAT(told, ElementsAre("1 a UNACKNOWLEDGED", "5 a LATCHED", "7 a UNACKNOWLEDGED",
                                "8 a LATCHED", "9 a NORMAL"));
  told.clear();
  cause(20, a);
  book.acknowledge(a, "ann");
  gone(25, a);
  EXPECT_THAT(told, ElementsAre("20 a UNACKNOWLEDGED", "25 a NORMAL"))
      << "who has seen it while it was there need not do so again";
}

TEST_F(AlarmLife, GraverThanWhatWasAcknowledgedIsNew) {
  const std::size_t a = declare("a");
  cause(1, a, Severity::minor);
  book.acknowledge(a, "ann");
  cause(2, a, Severity::major);
  EXPECT_EQ(book.alarm(a).state(), AlarmState::unacknowledged);
  book.acknowledge(a, "ann");
  cause(3, a, Severity::minor);
  cause(4, a, Severity::major);
  EXPECT_EQ(book.alarm(a).state(), AlarmState::acknowledged);
}

TEST_F(AlarmLife, OnTheShelfIsListedButNotActiveAndComesBackByItself) {
  const std::size_t a = declare("a");
  cause(1, a);
  pass(2);
  tell(book.shelve(a, 10.0, "ann").changed);
  EXPECT_EQ(book.active_count(), 0U);
  book.for_each_active([](const Alarm&) { FAIL() << "sent again from the shelf"; });
  EXPECT_EQ(book.persisted_alarms().size(), 1U);
  pass(11);
  EXPECT_EQ(book.shelved_for_s(book.alarm(a)), 1.0);
  pass(12);
  EXPECT_EQ(book.active_count(), 1U);
  tell(book.shelve(a, 10.0, "bob").changed);
  gone(14, a);
  tell(book.unshelve(a).changed);
  EXPECT_THAT(told, ElementsAre("1 a UNACKNOWLEDGED", "2 a SHELVED", "12 a UNACKNOWLEDGED",
                                "12 a SHELVED", "14 a SHELVED", "14 a RETURNED"));
  EXPECT_EQ(book.unshelve(a).refusal, "not shelved");
}

TEST_F(AlarmLife, IsNotShelvedForLongerThanItsLimit) {
  AlarmRules rules;
  rules.shelve_limit_s = 60.0;
  const std::size_t a = declare("a", rules);
  rules.shelve_limit_s = 0.0;
  const std::size_t never = declare("never", rules);
  EXPECT_EQ(book.shelve(a, 61.0, "ann").refusal, "shelving is limited to 60 s (shelve_limit_s)");
  EXPECT_EQ(book.shelve(a, 0.0, "ann").changed, nullptr);
  EXPECT_NE(book.shelve(a, 60.0, "ann").changed, nullptr);
  EXPECT_EQ(book.shelve(never, 1.0, "ann").refusal, "shelving is not allowed (shelve_limit_s = 0)");
}

TEST_F(AlarmLife, MarksTheFirstOfABurstUntilAllAreGoneAndAcknowledged) {
  const std::size_t a = declare("a");
  const std::size_t b = declare("b");
  cause(1, a);
  cause(2, b);
  EXPECT_TRUE(book.alarm(a).first_up);
  EXPECT_FALSE(book.alarm(b).first_up);
  gone(3, a);
  gone(4, b);
  cause(5, b);
  EXPECT_FALSE(book.alarm(b).first_up) << "the burst lasts while anything is unacknowledged";
  gone(6, b);
  book.acknowledge(a, "ann");
  EXPECT_FALSE(book.alarm(a).first_up);
  cause(7, a);
  EXPECT_FALSE(book.alarm(a).first_up);
  gone(8, a);
  book.acknowledge(a, "ann");
  book.acknowledge(b, "ann");
  cause(9, b);
  EXPECT_TRUE(book.alarm(b).first_up);
}

TEST_F(AlarmLife, ComesWithItsNthTimeInTheWindow) {
  AlarmRules rules;
  rules.count = 3;
  rules.count_window_s = 20.0;
  rules.chatter_count = 0;
  const std::size_t a = declare("a", rules);
  for (const std::int64_t tick : {1, 5, 30}) {  // 1 and 30 are too far apart
    cause(tick, a);
    gone(tick + 1, a);
  }
  EXPECT_THAT(told, IsEmpty());
  cause(35, a);
  gone(36, a);
  cause(45, a);
  EXPECT_THAT(told, ElementsAre("45 a UNACKNOWLEDGED"));
}

TEST_F(AlarmLife, ThatIsCountedComesAlsoWhenItsCauseLasts) {
  AlarmRules rules;
  rules.count = 3;
  rules.count_window_s = 20.0;
  const std::size_t a = declare("a", rules);
  cause(10, a);
  pass(29);
  EXPECT_THAT(told, IsEmpty());
  pass(30);
  EXPECT_THAT(told, ElementsAre("30 a UNACKNOWLEDGED"));
  EXPECT_EQ(book.alarm(a).reason, "outside");
}

TEST_F(AlarmLife, ThatChattersIsOneLongAlarm) {
  AlarmRules rules;
  rules.acknowledge = false;
  rules.chatter_count = 3;
  rules.chatter_window_s = 60.0;
  const std::size_t a = declare("a", rules);
  for (std::int64_t tick = 0; tick < 200; tick += 10) {
    cause(tick, a);
    gone(tick + 5, a);
  }
  EXPECT_THAT(told, ElementsAre("0 a ACKNOWLEDGED", "5 a NORMAL", "10 a ACKNOWLEDGED",
                                "15 a NORMAL", "20 a ACKNOWLEDGED"));
  EXPECT_THAT(book.alarm(a).reason, testing::HasSubstr("chattering"));
  pass(254);
  EXPECT_TRUE(book.alarm(a).active);
  pass(255);
  EXPECT_FALSE(book.alarm(a).active) << "60 s after it went for the last time";
  told.clear();
  cause(300, a);
  gone(301, a);
  EXPECT_THAT(told, ElementsAre("300 a ACKNOWLEDGED", "301 a NORMAL"));
}

TEST_F(AlarmLife, IsFoundByItsWholeNameOrByAUniqueOne) {
  declare("a");
  EXPECT_EQ(book.find("s.a"), 0U);
  EXPECT_EQ(book.find("a"), 0U);
  EXPECT_EQ(book.find("s"), AlarmBook::kNone);
  book.set_condition("t", "a", Severity::minor, true, "", 1);
  EXPECT_EQ(book.find("a"), AlarmBook::kNone);
  EXPECT_EQ(book.find("t.a"), 1U);
}

}  // namespace
}  // namespace estimator::fdi
