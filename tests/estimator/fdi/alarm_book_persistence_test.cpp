// The life of an alarm through a restart and under new rules.
#include <gmock/gmock.h>

#include "tests/estimator/fdi/alarm_fixture.h"

namespace estimator::fdi {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using AlarmRestart = AlarmLife;

TEST_F(AlarmRestart, SurvivesARestartAsFarAsItMatters) {
  AlarmRules latching;
  latching.latch = true;
  const char* names[] = {"seen", "unseen", "latched", "shelved", "normal"};
  for (const char* name : names) {
    declare(name, std::string(name) == "latched" ? latching : AlarmRules{});
  }
  for (std::size_t i = 0; i < 4; ++i) cause(1, i);
  gone(2, 2);
  book.acknowledge(0, "ann");
  book.shelve(3, 100.0, "bob");
  pass(41);
  const std::vector<PersistedAlarm> lives = book.persisted_alarms();
  ASSERT_EQ(lives.size(), 4U);

  book = AlarmBook(1.0);
  for (const char* name : names) {
    declare(name, std::string(name) == "latched" ? latching : AlarmRules{});
  }
  told.clear();
  book.restore(lives);
  EXPECT_EQ(book.alarm(0).state(), AlarmState::normal) << "until its cause is found again";
  EXPECT_EQ(book.alarm(1).state(), AlarmState::returned);
  EXPECT_EQ(book.alarm(2).state(), AlarmState::latched);
  EXPECT_EQ(book.alarm(3).state(), AlarmState::shelved);
  EXPECT_EQ(book.alarm(4).state(), AlarmState::normal);
  EXPECT_EQ(book.active_count(), 1U);
  EXPECT_EQ(book.alarm(3).shelved_by, "bob");
  cause(5, 0);
  EXPECT_THAT(told, ElementsAre("5 seen ACKNOWLEDGED")) << "nobody need acknowledge it again";
  EXPECT_EQ(book.alarm(0).times, 1);
  pass(60);
  EXPECT_TRUE(book.alarm(3).shelved);
  pass(61);
  EXPECT_FALSE(book.alarm(3).shelved) << "61 s were left of 100";
}

TEST_F(AlarmRestart, GoesOnUnderNewRules) {
  AlarmRules latching;
  latching.latch = true;
  for (const char* name : {"active", "latched", "shelved", "dropped"}) {
    declare(name, std::string(name) == "latched" ? latching : AlarmRules{});
  }
  for (std::size_t i = 0; i < 4; ++i) cause(1, i);
  gone(2, 1);
  book.acknowledge(0, "ann");
  book.shelve(2, 100.0, "bob");
  book.set_condition("recorder", "disk_full", Severity::minor, true, "full", 2);
  pass(10);
  told.clear();

  const AlarmBook before = book;
  book = AlarmBook(1.0);
  AlarmRules shorter;
  shorter.shelve_limit_s = 20.0;
  declare("new");
  declare("shelved", shorter);
  declare("latched", latching);
  declare("active");
  book.inherit(before);
  EXPECT_EQ(book.alarm(0).state(), AlarmState::normal);
  EXPECT_EQ(book.alarm(1).state(), AlarmState::shelved);
  EXPECT_EQ(book.alarm(2).state(), AlarmState::latched);
  EXPECT_EQ(book.alarm(3).state(), AlarmState::acknowledged);
  EXPECT_EQ(book.active_count(), 2U);
  cause(11, 3);
  EXPECT_THAT(told, IsEmpty()) << "it is still the same alarm";
  gone(12, 3);
  EXPECT_THAT(told, ElementsAre("12 active NORMAL"));
  pass(29);
  EXPECT_TRUE(book.alarm(1).shelved);
  pass(30);
  EXPECT_FALSE(book.alarm(1).shelved) << "the new limit counts from the change on";
}

TEST_F(AlarmRestart, ShelvesKeepTheirTimeWhenTicksBeginAgain) {
  const std::size_t a = declare("a");
  pass(1000);
  book.shelve(a, 100.0, "ann");
  pass(1040);
  pass(0);
  pass(59);
  EXPECT_TRUE(book.alarm(a).shelved);
  pass(60);
  EXPECT_FALSE(book.alarm(a).shelved);
}

}  // namespace
}  // namespace estimator::fdi
