// The messages to a service manager, on a socket of the test's own: readiness, signs of life,
// status.
#include "daemon/service_report.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <vector>

#include "tests/daemon/program/subprocess.h"

namespace monitor {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kWatchdog_ms = 400;

/// $NOTIFY_SOCKET and what came there.
class Ear {
 public:
  Ear() : file_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = (folder_.path() / "notify").string();
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(bind(file_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Ear() {
    unsetenv("NOTIFY_SOCKET");
    close(file_);
  }
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

  /// The messages since the last call, waited for up to so long.
  std::vector<std::string> heard(int wait_ms = 0) const {
    std::vector<std::string> all;
    const timeval patience{wait_ms / 1000, 1000 * (wait_ms % 1000)};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    char bytes[512];
    ssize_t n = recv(file_, bytes, sizeof bytes, wait_ms > 0 ? 0 : MSG_DONTWAIT);
    for (; n > 0; n = recv(file_, bytes, sizeof bytes, MSG_DONTWAIT)) {
      all.emplace_back(bytes, static_cast<std::size_t>(n));
    }
    return all;
  }

 private:
  program::Folder folder_;
  int file_;
};

class ServiceReportTest : public testing::Test {
 protected:
  ~ServiceReportTest() override { unsetenv("WATCHDOG_USEC"); }

  static io::ServiceManager with_watchdog() {
    setenv("WATCHDOG_USEC", std::to_string(kWatchdog_ms * 1000).c_str(), 1);
    unsetenv("WATCHDOG_PID");
    return {};
  }
  /// One period of 5 ms in which all, or only some, get on.
  void cycle(bool loop = true, bool detector = true, bool good = true) {
    clock_.advance_ns(5 * kMillisecond_ns);
    if (loop) stats_.ticks.add();
    if (loop && good) {
      stats_.rod.good.add();
      stats_.valve_good.add();
    }
    if (detector) stats_.detected_samples.add();
    report_.poll();
    for (const std::string& message : ear_.heard()) {
      if (message == "READY=1") ++ready_;
      if (message == "WATCHDOG=1") ++signs_;
      if (message.starts_with("STATUS=")) lines_.push_back(message);
    }
  }

  Ear ear_;
  rt::VirtualClock clock_;
  rt::LoopStats stats_;
  io::ServiceManager manager_ = with_watchdog();
  ServiceReport report_{manager_, clock_, stats_, true};
  int ready_ = 0;
  int signs_ = 0;
  std::vector<std::string> lines_;
};

TEST_F(ServiceReportTest, SaysReadyOnceAfterTwentyGoodCycles) {
  for (int i = 0; i < 19; ++i) cycle();
  EXPECT_EQ(ready_, 0);
  cycle();
  EXPECT_EQ(ready_, 1);
  for (int i = 0; i < 1000; ++i) cycle();
  EXPECT_EQ(ready_, 1);
}

TEST_F(ServiceReportTest, IsNotReadyWithoutReadingsWritesOrDetector) {
  for (int i = 0; i < 100; ++i) cycle(true, true, false);
  EXPECT_EQ(ready_, 0) << "without readings";
  stats_.rod.good.add(100);
  for (int i = 0; i < 100; ++i) cycle(true, true, false);
  EXPECT_EQ(ready_, 0) << "without writes";
  ServiceReport watching(manager_, clock_, stats_, false);
  watching.poll();
  EXPECT_THAT(ear_.heard(), Contains("READY=1")) << "where nothing is driven";
}

TEST_F(ServiceReportTest, IsNotReadyBeforeTheDetectorTookTheSamples) {
  for (int i = 0; i < 100; ++i) cycle(true, false);
  EXPECT_EQ(ready_, 0);
  for (int i = 0; i < 20; ++i) cycle();
  EXPECT_EQ(ready_, 1);
}

TEST_F(ServiceReportTest, GivesFourSignsOfLifeInTheWatchdogsTime) {
  for (int i = 0; i < 400; ++i) cycle();  // 2 s
  EXPECT_EQ(signs_, 2000 / (kWatchdog_ms / 4));
}

TEST_F(ServiceReportTest, AStuckDetectorIsNotFed) {
  for (int i = 0; i < 100; ++i) cycle();
  signs_ = 0;
  for (int i = 0; i < 400; ++i) cycle(true, false);
  EXPECT_EQ(signs_, 0);
  cycle();
  EXPECT_EQ(signs_, 1);
}

TEST_F(ServiceReportTest, AStuckLoopIsNotFed) {
  for (int i = 0; i < 100; ++i) cycle();
  signs_ = 0;
  for (int i = 0; i < 400; ++i) cycle(false, true);
  EXPECT_EQ(signs_, 0);
}

TEST_F(ServiceReportTest, StatusSaysStateAlarmsAndLatenessOnceASecondAtMost) {
  cycle();
  EXPECT_THAT(lines_, ElementsAre("STATUS=waiting for the first good cycles"));
  stats_.state = control::ArmingState::run;
  stats_.active_alarms = 2;
  for (int i = 0; i < 100; ++i) stats_.lateness.add(80'000);
  for (int i = 0; i < 1000; ++i) cycle();
  EXPECT_THAT(lines_, ElementsAre("STATUS=waiting for the first good cycles",
                                  "STATUS=RUN, active alarms: 2, lateness p99.9 0.08 ms, "
                                  "lost periods: 0"));
  lines_.clear();
  for (int i = 0; i < 1000; ++i) {  // 5 s in which it changes all the time
    stats_.skipped_periods.add();
    cycle();
  }
  EXPECT_GE(lines_.size(), 4U);
  EXPECT_LE(lines_.size(), 5U);
}

TEST_F(ServiceReportTest, WithoutAWatchdogNoSignOfLifeIsGiven) {
  unsetenv("WATCHDOG_USEC");
  const io::ServiceManager manager;
  EXPECT_EQ(manager.watchdog_ns(), 0);
  ServiceReport report(manager, clock_, stats_, true);
  stats_.ticks.add();
  stats_.detected_samples.add();
  clock_.advance_ns(10'000 * kMillisecond_ns);
  report.poll();
  EXPECT_THAT(ear_.heard(), Not(Contains("WATCHDOG=1")));
}

TEST(ServiceProgram, TellsWhenItIsReadyAndWhenItStops) {
  const Ear ear;
  program::Daemon daemon({"--config", program::shipped("spoolwatchd.toml"), "--lcm-url", "",
                          "--set", "recorder.folder=", "--set", "alarms.folder=", "--set",
                          "evidence.folder=", "--set", "control.socket="});
  std::vector<std::string> heard;
  const auto listen = [&](const std::string& until) {
    for (int i = 0; i < 100; ++i) {
      for (const std::string& message : ear.heard(100)) heard.push_back(message);
      for (const std::string& message : heard) {
        if (message.starts_with(until)) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(listen("READY=1"));
  EXPECT_TRUE(listen("STATUS=DISARMED"));
  kill(daemon.pid(), SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
  EXPECT_TRUE(listen("STOPPING=1"));
}

TEST(ServiceProgram, IsSilentWhereNoServiceManagerWaits) {
  const Ear ear;
  unsetenv("NOTIFY_SOCKET");
  const io::ServiceManager manager;
  manager.ready();
  manager.status("nobody hears this");
  EXPECT_THAT(ear.heard(), IsEmpty());
}

}  // namespace
}  // namespace monitor
