#include "daemon/detection/system_alarms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cerrno>

namespace monitor::detection {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class SystemAlarmsTest : public testing::Test {
 protected:
  std::vector<std::string> report(std::int64_t tick) {
    std::vector<std::string> changes;
    system_alarms_.report(publisher_, recorder_, tick, book_, [&](const auto& alarm) {
      changes.push_back(alarm.source + "." + alarm.name + (alarm.active ? " on" : " off"));
    });
    return changes;
  }

  estimator::fdi::AlarmBook book_;
  SystemAlarms system_alarms_;
  io::PublisherStatus publisher_;
  io::RecorderStatus recorder_;
};

TEST_F(SystemAlarmsTest, ComeAndGoWithTheirCause) {
  EXPECT_THAT(report(0), IsEmpty());
  recorder_.disk_full = true;
  recorder_.error = ENOSPC;
  EXPECT_THAT(report(200), ElementsAre("recorder.disk_full on"));
  EXPECT_THAT(report(400), IsEmpty());
  EXPECT_EQ(book_.active_count(), 1U);
  recorder_.disk_full = false;
  recorder_.error = 0;
  EXPECT_THAT(report(600), ElementsAre("recorder.disk_full off"));
  recorder_.write_failed = true;
  recorder_.error = EIO;
  EXPECT_THAT(report(800), ElementsAre("recorder.write_failed on"));
  EXPECT_EQ(book_.alarms()[1].reason, "Input/output error; the newest data is kept in memory");
}

TEST_F(SystemAlarmsTest, LastAsLongAsACountGrows) {
  recorder_.dropped_records = 3;
  publisher_.send_failures = 1;
  EXPECT_THAT(report(0), ElementsAre("recorder.dropping on", "lcm.send_failed on"));
  recorder_.dropped_records = 5;
  EXPECT_THAT(report(200), ElementsAre("lcm.send_failed off"));
  EXPECT_THAT(report(400), ElementsAre("recorder.dropping off"));
  recorder_.removed_records = 838;
  EXPECT_THAT(report(600), ElementsAre("recorder.log_removed on"));
  EXPECT_EQ(book_.alarms().back().reason,
            "a log was removed while it was written; 838 messages are on no disk");
  EXPECT_THAT(report(800), ElementsAre("recorder.log_removed off"));
}

}  // namespace
}  // namespace monitor::detection
