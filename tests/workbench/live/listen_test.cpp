// `spoolwatch listen` as a process of its own, against publishers in this one.
#include <gtest/gtest.h>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "tests/workbench/live/subprocess.h"

namespace workbench::live {
namespace {

namespace fs = std::filesystem;
using monitor::io::Publisher;
using nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::string kProgram = std::string(SPOOLWATCH_BIN_DIR) + "/spoolwatch";

// Tests of one run in parallel do not hear each other.
std::string own_url() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
}

estimator::fdi::Alarm b1_low(bool active) {
  estimator::fdi::Alarm alarm;
  alarm.source = "period";
  alarm.name = "b1_low";
  alarm.quantity = "period.b1";
  alarm.parameter = "supply_pressure_Pa";
  alarm.severity = active ? estimator::fdi::Severity::major : estimator::fdi::Severity::ok;
  alarm.active = active;
  alarm.acknowledged = !active;
  alarm.direction = active ? -1 : 0;
  alarm.value = 1.8e-4;
  alarm.std_error = 1e-6;
  alarm.low = 1.9e-4;
  alarm.high = 2.1e-4;
  alarm.guidance = "check the pump";
  return alarm;
}

spoolwatch::health_t health() {
  spoolwatch::health_t message{};
  message.rig_id = "bench";
  message.lateness_max_us = kNaN;
  return message;
}

class ListenTest : public testing::Test {
 protected:
  Subprocess listen(std::vector<std::string> more = {}) const {
    std::vector<std::string> command{kProgram, "listen", "--lcm-url", url_};
    command.insert(command.end(), more.begin(), more.end());
    return Subprocess(command);
  }
  // Sends until the listener, which takes a moment to join the group, is heard to hear.
  static std::string send_until(Subprocess& process, const std::string& part,
                                const std::function<void()>& send) {
    for (int i = 0; i < 200; ++i) {
      send();
      const std::string line = process.line_with(part, 0.1);
      if (!line.empty()) return line;
    }
    return "";
  }

  std::string url_ = own_url();
};

TEST_F(ListenTest, ReceivesAnAlarmOfAnotherProcessAsOneJsonObject) {
  Publisher publisher({.url = url_}, 99, 0.005, nullptr);
  Subprocess process = listen({"--json"});
  const std::string line = send_until(process, "\"alarm\"", [&] {
    publisher.alarm(b1_low(true), false, {5'000'000, 5});
  });
  ASSERT_NE(line, "") << process.all();
  const json alarm = json::parse(line);
  EXPECT_EQ(alarm["run_id"], 99);
  EXPECT_EQ(alarm["name"], "b1_low");
  EXPECT_EQ(alarm["severity"], "MAJOR");
  EXPECT_EQ(alarm["active"], true);
  EXPECT_EQ(alarm["value"], 1.8e-4);
  EXPECT_EQ(alarm["parameter"], "supply_pressure_Pa");
  EXPECT_TRUE(alarm["confidence"].is_null());
  const std::string health_line = send_until(
      process, "\"health\"", [&, message = health()]() mutable { publisher.health(message, {}); });
  EXPECT_TRUE(json::parse(health_line)["lateness_max_us"].is_null());
}

TEST_F(ListenTest, PrintsAnAlarmOnceHoweverOftenItIsRepeated) {
  Publisher publisher({.url = url_}, 99, 0.005, nullptr);
  Subprocess process = listen();
  // A late subscriber learns of the alarm from a repeat.
  const std::string first = send_until(process, "b1_low", [&] {
    publisher.alarm(b1_low(true), true, {5'000'000, 5});
  });
  EXPECT_EQ(first,
            "5.000 s     MAJOR    period.b1_low       still active; period.b1 = 0.00018 +- 1e-06, "
            "below 0.00019 .. 0.00021; means supply_pressure_Pa low; do: check the pump");
  for (int i = 0; i < 5; ++i) publisher.alarm(b1_low(true), true, {6'000'000, 5});
  publisher.alarm(b1_low(false), false, {7'000'000, 5});
  const std::string second = process.line_with("b1_low");
  EXPECT_EQ(second,
            "7.000 s     OK       period.b1_low       back to normal; period.b1 = 0.00018 +- "
            "1e-06, band 0.00019 .. 0.00021");
}

TEST_F(ListenTest, RaisesAnAlarmOfItsOwnAfterThreeSecondsWithoutHealthAndEndsIt) {
  Publisher publisher({.url = url_}, 99, 0.005, nullptr);
  const auto start = std::chrono::steady_clock::now();
  Subprocess process = listen({"--json"});
  const json silent = json::parse(process.line_with("silence"));
  const std::chrono::duration<double> after = std::chrono::steady_clock::now() - start;
  EXPECT_GE(after.count(), 3.0);
  EXPECT_EQ(silent["severity"], "MAJOR");
  EXPECT_EQ(silent["active"], true);
  const std::string line = send_until(
      process, "silence", [&, message = health()]() mutable { publisher.health(message, {}); });
  EXPECT_EQ(json::parse(line)["active"], false);
}

TEST_F(ListenTest, TellsLostMessagesAndARestartedDaemon) {
  lcm::LCM sender(url_);
  const auto send = [&](std::int64_t run_id, std::int64_t seq) {
    spoolwatch::alarm_t alarm{};
    alarm.run_id = run_id;
    alarm.seq = seq;
    alarm.name = "x" + std::to_string(seq);
    sender.publish("SPOOLWATCH_ALARM", &alarm);
  };
  Subprocess process = listen();
  ASSERT_NE(send_until(process, "listening to run 5", [&] { send(5, 10); }), "");
  send(5, 11);
  send(5, 15);
  EXPECT_NE(process.line_with(": 3 messages of SPOOLWATCH_ALARM did not arrive").find("lost"),
            std::string::npos)
      << process.all();
  send(6, 0);
  EXPECT_NE(process.line_with("restarted: run 6"), "") << process.all();
  send(6, 1);
  EXPECT_NE(process.line_with("x1"), "");
  EXPECT_EQ(process.all().find("lost", process.all().find("restarted")), std::string::npos);
}

TEST_F(ListenTest, LeavesOutMessagesOfAnotherTypeAndSaysSoOnce) {
  lcm::LCM sender(url_);
  Subprocess process = listen();
  EXPECT_NE(send_until(process, "another type",
                       [&] { sender.publish("SPOOLWATCH_ALARM", "not an alarm", 12); }),
            "");
  sender.publish("SPOOLWATCH_ALARM", "not an alarm", 12);
  EXPECT_EQ(process.line_with("another type", 0.5), "");
}

TEST_F(ListenTest, EndsByItselfAfterItsDurationAndAtOnceOnASignal) {
  EXPECT_EQ(listen({"--duration", "0.3"}).exit_code(), 0);
  for (const int number : {SIGINT, SIGTERM}) {
    Publisher publisher({.url = url_}, 99, 0.005, nullptr);
    Subprocess process = listen();
    ASSERT_NE(send_until(process, "b1_low",
                         [&] {
                           publisher.alarm(b1_low(true), false, {5'000'000, 5});
                         }),
              "");
    process.signal(number);
    EXPECT_EQ(process.exit_code(), 0);
  }
}

TEST_F(ListenTest, AnswersAWrongUrlWithOneLineAndWrongOptionsWithUsage) {
  url_ = "udpm://rubbish";
  Subprocess process = listen();
  const std::string text = process.rest();
  EXPECT_EQ(process.exit_code(), 78);
  EXPECT_TRUE(text.starts_with("spoolwatch: LCM URL \"udpm://rubbish\": LCM cannot start")) << text;
  EXPECT_EQ(text.find('\n'), text.size() - 1);
  EXPECT_EQ(listen({"--nonsense"}).exit_code(), 2);
  EXPECT_EQ(listen({"--duration", "-3"}).exit_code(), 2);
}

// A log with two alarms, as the daemon's recorder leaves it.
fs::path recorded_log(const fs::path& folder) {
  monitor::io::Recorder recorder({.folder = folder}, 3, false);
  Publisher publisher({.url = ""}, 3, 0.005, &recorder);
  publisher.alarm(b1_low(true), false, {5'000'000, 5});
  publisher.alarm(b1_low(false), false, {5'200'000, 6});
  return folder / "spoolwatch-3-00000.lcmlog";
}

class LogTest : public ListenTest {
 protected:
  LogTest() {
    std::string name = (fs::temp_directory_path() / "listen-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    log_ = recorded_log(folder_);
  }
  ~LogTest() override { fs::remove_all(folder_); }

  static bool has(const char* tool) {
    return std::system((std::string("command -v ") + tool + " >/dev/null").c_str()) == 0;
  }

  fs::path folder_;
  fs::path log_;
};

TEST_F(LogTest, ReplaysALogToItsEndAndEnds) {
  url_ = "file://" + log_.string() + "?mode=r";
  Subprocess process = listen({"--json"});
  EXPECT_EQ(json::parse(process.line_with("\"alarm\""))["active"], true);
  EXPECT_EQ(json::parse(process.line_with("\"alarm\""))["active"], false);
  EXPECT_EQ(process.exit_code(), 0);
}

TEST_F(LogTest, OfTheRecorderIsReplayedByLcmsOwnPlayer) {
  if (!has("lcm-logplayer")) GTEST_SKIP() << "lcm-logplayer is not installed (liblcm-bin)";
  Subprocess process = listen({"--json"});
  const std::string line = send_until(process, "\"alarm\"", [&] {
    Subprocess player({"lcm-logplayer", "--lcm-url=" + url_, log_.string()});
    player.exit_code();
  });
  EXPECT_EQ(json::parse(line)["name"], "b1_low");
}

TEST_F(LogTest, OfLcmsOwnLoggerIsReplayed) {
  if (!has("lcm-logger")) GTEST_SKIP() << "lcm-logger is not installed (liblcm-bin)";
  const fs::path logged = folder_ / "logged";
  Publisher publisher({.url = url_}, 99, 0.005, nullptr);
  {
    Subprocess logger(
        {"lcm-logger", "--quiet", "--lcm-url=" + url_, "--flush-interval=1", logged.string()});
    for (int i = 0; i < 200 && (!fs::exists(logged) || fs::file_size(logged) == 0); ++i) {
      publisher.alarm(b1_low(true), false, {5'000'000 + i, 5});
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    logger.signal(SIGINT);
    logger.exit_code();
  }
  url_ = "file://" + logged.string() + "?mode=r&speed=0";
  Subprocess process = listen({"--json"});
  const std::string line = process.line_with("\"alarm\"");
  ASSERT_NE(line, "") << process.all();
  EXPECT_EQ(json::parse(line)["run_id"], 99);
}

}  // namespace
}  // namespace workbench::live
