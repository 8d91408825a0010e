// People's acts on their way to the book, and guards that live like any alarm.
#include "daemon/detection/alarm_command_queue.h"

#include <gmock/gmock.h>

#include "daemon/control/guard_monitor.h"
#include "daemon/detection/system_alarms.h"
#include "daemon/rt/guard_status.h"

namespace monitor::detection {
namespace {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::AlarmRules;
using estimator::fdi::AlarmState;
using estimator::fdi::Severity;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = AlarmCommand::Kind;

class AlarmCommandServerTest : public testing::Test {
 protected:
  AlarmAnswer command(Kind kind, const std::string& alarm = "", double time_s = 0.0) {
    commands_.push({kind, alarm, "ann", time_s, ++number_});
    server_.serve(book_, [this](const Alarm& changed) { changed_.push_back(changed.name); });
    std::shared_ptr<const AlarmAnswer> answer;
    EXPECT_TRUE(answers_.pop(answer));
    EXPECT_EQ(answer->number, number_);
    return *answer;
  }

  AlarmBook book_{1.0};
  AlarmCommandQueue commands_;
  AlarmAnswerQueue answers_;
  AlarmCommandServer server_{&commands_, &answers_};
  std::uint32_t number_ = 0;
  std::vector<std::string> changed_;
};

TEST_F(AlarmCommandServerTest, CarriesOutWhatIsOrderedAndTellsWhatHasChanged) {
  for (const char* name : {"a", "b", "c"}) {
    book_.set_condition("s", name, Severity::minor, true, "", 1);
  }
  book_.set_condition("s", "c", Severity::minor, false, "", 2);
  EXPECT_THAT(command(Kind::shelve, "s.a", 60.0).done, ElementsAre("s.a"));
  EXPECT_EQ(book_.alarm(0).shelved_by, "ann");
  EXPECT_THAT(command(Kind::acknowledge, "b").done, ElementsAre("s.b"));
  EXPECT_THAT(changed_, ElementsAre("a", "b"));
  const AlarmAnswer all = command(Kind::acknowledge_all);
  EXPECT_THAT(all.done, ElementsAre("s.a", "s.c")) << "what nobody had acknowledged";
  EXPECT_THAT(command(Kind::acknowledge_all).done, IsEmpty());
  EXPECT_THAT(command(Kind::unshelve, "a").done, ElementsAre("s.a"));
}

TEST_F(AlarmCommandServerTest, RefusesInWords) {
  book_.set_condition("s", "a", Severity::minor, true, "", 1);
  EXPECT_THAT(command(Kind::acknowledge, "x").reject_reason, HasSubstr("no alarm \"x\""));
  EXPECT_EQ(command(Kind::unshelve, "a").reject_reason, "s.a: not shelved");
  EXPECT_THAT(command(Kind::shelve, "a", 1e9).reject_reason,
              HasSubstr("s.a: shelving is limited to"));
  EXPECT_THAT(changed_, IsEmpty());
}

TEST_F(AlarmCommandServerTest, ListsEveryAlarmWithWhatIsLeftOfItsShelf) {
  book_.set_condition("s", "a", Severity::minor, true, "why", 1);
  command(Kind::shelve, "a", 60.0);
  book_.advance(20, 0, [](const Alarm&) {});
  const AlarmAnswer list = command(Kind::list);
  ASSERT_EQ(list.alarms.size(), 1U);
  EXPECT_EQ(list.alarms[0].alarm.reason, "why");
  EXPECT_EQ(list.alarms[0].shelved_for_s, 40.0);
}

TEST(GuardAlarms, LiveByTheRulesOfAllThatIsNoBand) {
  const auto guards = control::all_guards({}, control::Action::latch);
  control::GuardMonitor monitor(guards, 0.005);
  rt::GuardStatus status;
  AlarmBook book(0.005);
  AlarmRules rules;
  rules.latch = true;
  book.set_condition_rules(rules);
  GuardAlarms alarms(guards, book);
  const std::size_t e_stop = book.find("loop.e_stop");
  ASSERT_NE(e_stop, AlarmBook::kNone);
  std::vector<AlarmState> lives;
  const auto report = [&](bool pressed, std::int64_t tick) {
    monitor.set(control::GuardKind::e_stop, pressed, 0.0);
    status.update(monitor);
    book.advance(tick, 0, [](const Alarm&) {});
    alarms.report(status, tick, [&](const Alarm& alarm) { lives.push_back(alarm.state()); });
  };
  report(true, 1);
  report(false, 2);  // shown as active once more: it was, since the last look
  report(false, 3);
  EXPECT_THAT(lives, ElementsAre(AlarmState::unacknowledged, AlarmState::latched));
  book.acknowledge(e_stop, "ann");
  EXPECT_EQ(book.alarm(e_stop).state(), AlarmState::normal);
}

}  // namespace
}  // namespace monitor::detection
