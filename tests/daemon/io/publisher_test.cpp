#include "daemon/io/publisher.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "tests/daemon/io/log_reader.h"

namespace monitor::io {
namespace {

namespace fs = std::filesystem;
using config::signals::Sample;

constexpr double kSampleTime_s = 0.005;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class PublisherTest : public testing::Test {
 protected:
  PublisherTest() {
    std::string name = (fs::temp_directory_path() / "publisher-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~PublisherTest() override { fs::remove_all(folder_); }

  static Sample sample(std::int64_t tick) {
    Sample sample;
    sample.tick = tick;
    sample.utc_us = 5000 * tick;
    sample.t_read_ns = 5'000'000 * tick;
    sample.t_write_ns = sample.t_read_ns + 9000;
    sample.reference_m = 0.02;
    sample.y_m = 0.001 * static_cast<double>(tick);
    sample.u_requested_V = 12.0;
    sample.u_applied_V = 10.0 - static_cast<double>(tick);
    sample.state = 3;
    sample.saturated = true;
    return sample;
  }

  template <class Message>
  static Message decode(const Event& event) {
    Message message{};
    EXPECT_EQ(message.decode(event.data.data(), 0, static_cast<int>(event.data.size())),
              static_cast<int>(event.data.size()));
    return message;
  }

  fs::path folder_;
};

TEST_F(PublisherTest, RecordsEveryFieldOfEveryMessage) {
  {
    Recorder recorder({.folder = folder_}, 11, false);
    Publisher publisher({.url = "", .prefix = "RIG"}, 11, kSampleTime_s, &recorder);
    publisher.sample(sample(4));
    publisher.sample(sample(5));
    const estimator::fdi::EstimatedValue values[] = {{"a1", -1.0, 0.25, kNaN, kNaN},
                                                     {"b1", 2e-4, 1e-6, 1.9e-4, 2.1e-4}};
    estimator::fdi::EstimateEvent event{};
    event.source = "period";
    event.tick = 5;
    event.valid = false;
    event.reason = "not excited";
    event.condition = 33.0;
    event.begin_values = std::begin(values);
    event.end_values = std::end(values);
    publisher.estimate(event, {26'000, 26'000'000});
    estimator::fdi::Alarm alarm;
    alarm.source = "period";
    alarm.name = "b1_low";
    alarm.quantity = "period.b1";
    alarm.parameter = "supply_pressure_Pa";
    alarm.falls_with_parameter = true;
    alarm.ambiguity_group = {"supply_pressure_Pa", "gain"};
    alarm.severity = estimator::fdi::Severity::major;
    alarm.active = true;
    alarm.first_up = true;
    alarm.direction = -1;
    alarm.tick = 5;
    alarm.value = 1.8e-4;
    alarm.low = 1.9e-4;
    publisher.alarm(alarm, true, {27'000, 27'000'000});
    spoolwatch::health_t health{};
    health.ticks = 6;
    publisher.health(health, {28'000, 28'000'000});
  }
  const auto events = read_events(logs_in(folder_).at(0));
  ASSERT_EQ(events.size(), 5U);
  EXPECT_EQ(events[1].channel, "RIG_SAMPLE");
  EXPECT_EQ(events[1].utc_us, 25'000);
  const auto second = decode<spoolwatch::sample_t>(events[1]);
  EXPECT_EQ(second.run_id, 11);
  EXPECT_EQ(second.seq, 1);
  EXPECT_EQ(second.tick, 5);
  EXPECT_EQ(second.mono_ns, 25'000'000);
  EXPECT_EQ(second.t_write_ns, 25'009'000);
  EXPECT_EQ(second.sample_time_s, kSampleTime_s);
  EXPECT_EQ(second.u_requested_V, 12.0);
  EXPECT_EQ(second.u_applied_V, 5.0);
  EXPECT_EQ(second.state, 3);
  EXPECT_EQ(second.saturated, 1);
  EXPECT_EQ(events[2].channel, "RIG_ESTIMATE");
  const auto estimate = decode<spoolwatch::estimate_t>(events[2]);
  EXPECT_EQ(estimate.seq, 0);
  EXPECT_EQ(estimate.valid, 0);
  EXPECT_EQ(estimate.reason, "not excited");
  EXPECT_EQ(estimate.name, (std::vector<std::string>{"a1", "b1"}));
  EXPECT_EQ(estimate.std_error, (std::vector<double>{0.25, 1e-6}));
  EXPECT_TRUE(std::isnan(estimate.low[0]));
  EXPECT_EQ(estimate.high[1], 2.1e-4);
  EXPECT_EQ(events[3].channel, "RIG_ALARM");
  const auto alarm = decode<spoolwatch::alarm_t>(events[3]);
  EXPECT_EQ(alarm.name, "b1_low");
  EXPECT_EQ(alarm.severity, 2);
  EXPECT_EQ(alarm.repeat, 1);
  EXPECT_EQ(alarm.first_up, 1);
  EXPECT_EQ(alarm.direction, -1);
  EXPECT_EQ(alarm.parameter_direction, +1);
  EXPECT_EQ(alarm.ambiguity_group.size(), 2U);
  EXPECT_TRUE(std::isnan(alarm.high));
  EXPECT_EQ(events[4].channel, "RIG_HEALTH");
  EXPECT_EQ(decode<spoolwatch::health_t>(events[4]).ticks, 6);
}

TEST_F(PublisherTest, TellsPressuresJustBeforeTheirSampleWhereTheRigMeasuresThem) {
  const auto channels = [&](bool measures) {
    {
      Recorder recorder({.folder = folder_}, measures ? 11 : 12, false);
      Publisher publisher({.url = "", .prefix = "RIG"}, 11, kSampleTime_s, &recorder);
      if (measures) publisher.enable_pressures();
      Sample with = sample(4);
      with.pressures = {7e6, 4.5e6, 2.5e6};
      publisher.sample(with);
      publisher.sample(sample(5));
    }
    return read_events(logs_in(folder_).at(measures ? 0 : 1));
  };
  const auto events = channels(true);
  ASSERT_EQ(events.size(), 4U);
  EXPECT_EQ(events[0].channel, "RIG_PRESSURES");
  EXPECT_EQ(events[1].channel, "RIG_SAMPLE");
  EXPECT_EQ(events[2].channel, "RIG_PRESSURES");
  const auto first = decode<spoolwatch::pressures_t>(events[0]);
  EXPECT_EQ(first.run_id, 11);
  EXPECT_EQ(first.seq, 0);
  EXPECT_EQ(first.tick, 4);
  EXPECT_EQ(first.utc_us, 20'000);
  EXPECT_EQ(first.mono_ns, 20'000'000);
  EXPECT_EQ(first.supply_Pa, 7e6);
  EXPECT_EQ(first.in_Pa, 4.5e6);
  EXPECT_EQ(first.out_Pa, 2.5e6);
  const auto second = decode<spoolwatch::pressures_t>(events[2]);
  EXPECT_EQ(second.seq, 1);
  EXPECT_EQ(second.tick, 5);
  EXPECT_TRUE(std::isnan(second.supply_Pa)) << "none, and never the last one again";
  EXPECT_EQ(channels(false).size(), 2U);
}

TEST_F(PublisherTest, LeavesALogThatIsARecord) {
  {
    Recorder recorder({.folder = folder_}, 1, false);
    Publisher publisher({.url = ""}, 1, kSampleTime_s, &recorder);
    for (int tick = 0; tick < 10; ++tick) publisher.sample(sample(tick));
  }
  const auto record = config::record::read_record(logs_in(folder_).at(0));
  ASSERT_EQ(record.size(), 10U);
  EXPECT_EQ(record.sample_time_s, kSampleTime_s);
  EXPECT_EQ(record.y_m[7], 0.001 * 7.0);
  EXPECT_EQ(record.u_V[7], 3.0);
}

TEST_F(PublisherTest, SaysInOneLineWhatIsWrongWithAUrl) {
  const std::pair<const char*, const char*> kCases[] = {
      {"udpm://1.2.3.4.5:7667", "Bad multicast IP address"},
      {"udpm://239.255.76.67:99999", "Bad multicast port"},
      {"radio://x", "LCM provider \"radio\" not found"},
      {"nonsense", "invalid URL"},
      {"tcpq://127.0.0.1:9", "LCM cannot start"},
  };
  for (const auto& [url, what] : kCases) {
    try {
      const Publisher publisher({.url = url}, 1, kSampleTime_s, nullptr);
      ADD_FAILURE() << url << ": no error";
    } catch (const config::schema::ConfigError& error) {
      const std::string line = error.what();
      EXPECT_NE(line.find(url), std::string::npos) << line;
      EXPECT_NE(line.find(what), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
}

constexpr int kNoRight = 77;

// Runs `body` in a process with a network namespace of its own, where there is no route to
// anywhere; returns its exit code.
template <class Body>
int without_network(Body body) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWNET) != 0) ::_exit(kNoRight);
    ::_exit(body());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

int run(const std::string& command) { return std::system((command + " 2>/dev/null").c_str()); }

TEST_F(PublisherTest, WithoutANetworkIsOneClearError) {
  const int result = without_network([] {
    try {
      const Publisher publisher({}, 1, kSampleTime_s, nullptr);
    } catch (const config::schema::Error& error) {
      const std::string line = error.what();
      return line.find("Network is unreachable") != std::string::npos
                 ? config::schema::exit_code_of(error)
                 : 1;
    }
    return 0;
  });
  if (result == kNoRight) GTEST_SKIP() << "no right to make a network namespace";
  EXPECT_EQ(result, 78);
}

TEST_F(PublisherTest, CountsWhatALostNetworkKeepsFromBeingSentAndStillRecordsIt) {
  const int result = without_network([&] {
    if (run("ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo") != 0) {
      return kNoRight;
    }
    Recorder recorder({.folder = folder_}, 1, false);
    Publisher publisher({}, 1, kSampleTime_s, &recorder);
    for (int tick = 0; tick < 10; ++tick) publisher.sample(sample(tick));
    if (publisher.status().sent != 10) return 1;
    run("ip link set lo down");
    for (int tick = 10; tick < 30; ++tick) publisher.sample(sample(tick));
    if (publisher.status().send_failures != 20) return 2;
    run("ip link set lo up && ip route add 224.0.0.0/4 dev lo");
    for (int tick = 30; tick < 40; ++tick) publisher.sample(sample(tick));
    if (publisher.status().sent != 20) return 3;
    return recorder.status().written_records == 40 ? 0 : 4;
  });
  if (result == kNoRight) GTEST_SKIP() << "no right to make a network namespace, or no `ip`";
  EXPECT_EQ(result, 0);
}

TEST_F(PublisherTest, RefusesAPrefixThatMakesChannelNamesTooLongForLcm) {
  const std::string longest(53, 'P');  // 53 + "_PRESSURES" = 63 characters, LCM's limit
  EXPECT_NO_THROW(Publisher({.url = "", .prefix = longest}, 1, kSampleTime_s, nullptr));
  EXPECT_THROW(Publisher({.url = "", .prefix = longest + "P"}, 1, kSampleTime_s, nullptr),
               config::schema::Error);
}

}  // namespace
}  // namespace monitor::io
