// Figures of alarm quality from histories that are written here.
#include "workbench/control/alarm_statistics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "config/schema/error.h"

namespace workbench::control {
namespace {

using testing::ElementsAre;
using testing::Pair;

class AlarmStatisticsTest : public testing::Test {
 protected:
  AlarmStatisticsTest() {
    std::string name = (std::filesystem::temp_directory_path() / "history-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~AlarmStatisticsTest() override { std::filesystem::remove_all(folder_); }

  static std::string time(double t_s) {
    const auto s = static_cast<std::int64_t>(t_s);
    return fmt::format("2026-03-{:02}T{:02}:{:02}:{:02}.{:03}Z", 1 + s / 86400, s / 3600 % 24,
                       s / 60 % 60, s % 60, static_cast<int>((t_s - static_cast<double>(s)) * 1e3));
  }
  void event(double t_s, const std::string& what) {
    text_ += "{\"utc\":\"" + time(t_s) + "\",\"event\":\"" + what + "\"}\n";
  }
  void alarm(double t_s, const std::string& name, bool active, const std::string& state = "") {
    text_ += "{\"utc\":\"" + time(t_s) + "\",\"alarm\":\"" + name + "\",\"severity\":\"" +
             (active ? "MAJOR" : "OK") + "\",\"state\":\"" +
             (state.empty() ? (active ? "UNACKNOWLEDGED" : "NORMAL") : state) +
             "\",\"active\":" + (active ? "true" : "false") + "}\n";
  }
  AlarmStatistics statistics() {
    std::ofstream(folder_ / "history.log") << text_;
    return alarm_statistics(read_history(folder_));
  }

  std::filesystem::path folder_;
  std::string text_;
};

TEST_F(AlarmStatisticsTest, CountsTheTimeInWhichADaemonRan) {
  event(0, "start");
  alarm(100, "band.a", true);
  alarm(200, "band.a", false);
  event(3600, "end");
  event(7200, "start");
  alarm(7300, "band.a", true);
  alarm(10800, "band.b", true);  // killed: until here
  event(20000, "start");
  event(21800, "end");
  const AlarmStatistics s = statistics();
  EXPECT_EQ(s.observed_s, 3600.0 + 3600.0 + 1800.0);
  EXPECT_EQ(s.annunciations, 3);
  EXPECT_NEAR(s.per_hour, 3.0 / 2.5, 1e-12);
  EXPECT_THAT(s.frequent, ElementsAre(Pair("band.a", 2), Pair("band.b", 1)));
  EXPECT_THAT(s.standing, ElementsAre("band.a", "band.b"));
  EXPECT_TRUE(s.stale.empty());
  EXPECT_TRUE(s.chattering.empty());
}

TEST_F(AlarmStatisticsTest, FindsChatteringStaleAlarmsAndFloods) {
  event(0, "start");
  alarm(1, "loop.old", true);
  for (int i = 0; i < 5; ++i) {
    alarm(1000 + 10 * i, "band.noisy", true);
    alarm(1005 + 10 * i, "band.noisy", false);
  }
  // Twelve at once, 2 s apart: the eleventh begins a flood, which lasts until the second of them is
  // ten minutes old.
  for (int i = 0; i < 12; ++i) alarm(10000 + 2 * i, "band.f" + std::to_string(i), true);
  alarm(90000, "band.f0", false);
  event(100000, "end");
  const AlarmStatistics s = statistics();
  EXPECT_THAT(s.chattering, ElementsAre(Pair("band.noisy", 5)));
  EXPECT_EQ(s.most_in_10_min, 12);
  EXPECT_NEAR(s.flood_ratio, (602.0 - 20.0) / 100000.0, 1e-9);
  EXPECT_EQ(s.standing.size(), 12U);
  EXPECT_EQ(s.stale.size(), 12U);
  std::ostringstream out;
  print_statistics(s, out);
  EXPECT_THAT(out.str(), testing::HasSubstr("band.noisy: 5"));
}

TEST_F(AlarmStatisticsTest, ARateNeedsAnHour) {
  event(0, "start");
  alarm(10, "a.b", true);
  event(90, "end");
  std::ostringstream out;
  print_statistics(statistics(), out);
  EXPECT_THAT(out.str(), testing::HasSubstr("1 alarm in 1.5 min of a running daemon"));
  EXPECT_THAT(out.str(), testing::HasSubstr("per hour             -"));
}

TEST_F(AlarmStatisticsTest, AShelvedAlarmIsNoneAndComesWhenItIsBack) {
  event(0, "start");
  alarm(10, "a.b", true, "SHELVED");
  alarm(20, "a.b", true, "UNACKNOWLEDGED");
  alarm(30, "a.b", true, "ACKNOWLEDGED");
  EXPECT_EQ(statistics().annunciations, 1);
}

TEST_F(AlarmStatisticsTest, PassesOverDamagedLinesAndReadsThePredecessor) {
  event(0, "start");
  alarm(10, "a.b", true);
  std::ofstream(folder_ / "history.log.1") << text_;
  text_ = "{\"utc\":\"yesterday\",\"alarm\":\"x\"}\nnonsense\n[]\n{\"utc\":5}\n";
  alarm(20, "a.b", false);
  const AlarmStatistics s = statistics();
  EXPECT_EQ(s.annunciations, 1);
  EXPECT_TRUE(s.standing.empty());
  EXPECT_EQ(s.damaged_lines, 4U);
}

TEST_F(AlarmStatisticsTest, IsOneLineWhereThereIsNoHistory) {
  EXPECT_THROW((void)read_history(folder_), config::schema::RunError);
}

}  // namespace
}  // namespace workbench::control
