// `spoolwatch bridge` between a publisher in this process and peers that take UDP.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <functional>
#include <string>

#include "config/schema/error.h"
#include "daemon/io/publisher.h"
#include "estimator/fdi/pipeline.h"
#include "tests/workbench/live/subprocess.h"
#include "workbench/exchange/udp_sender.h"

namespace workbench::exchange {
namespace {

using live::Subprocess;
using monitor::io::Publisher;
using testing::HasSubstr;

const std::string kProgram = std::string(SPOOLWATCH_BIN_DIR) + "/spoolwatch";

std::string own_url() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
}

void send_sample(Publisher& publisher, int tick) {
  config::signals::Sample sample;
  sample.tick = tick;
  sample.utc_us = 5'000'000 + tick * 5000;
  sample.y_m = 0.125;
  sample.u_applied_V = tick;
  publisher.sample(sample);
}

/// Sends until `process`, which takes a moment to join the group, prints a line with `part`.
std::string line_after(Subprocess& process, const std::string& part,
                       const std::function<void(int)>& send) {
  for (int i = 0; i < 300; ++i) {
    send(i);
    const std::string line = process.line_with(part, 0.1);
    if (!line.empty()) return line;
  }
  return "";
}

TEST(Bridge, SendsWhatPlotJugglerTakes) {
  Subprocess peer({"python3", SPOOLWATCH_SOURCE_DIR "/tests/workbench/exchange/udp_peer.py"});
  const std::string port = peer.line_with("port");
  ASSERT_FALSE(port.empty());
  const std::string url = own_url();
  Publisher publisher({.url = url}, 3, 0.005, nullptr);
  Subprocess bridge({kProgram, "bridge", "--lcm-url", url, "--udp", "127.0.0.1:" + port.substr(5)});

  EXPECT_EQ(line_after(peer, "/sample/y_m", [&](int) { send_sample(publisher, 200); }),
            "True 6.0 /sample/y_m 0.125");
  EXPECT_EQ(peer.line_with("/sample/u_applied_V"), "True 6.0 /sample/u_applied_V 200.0");
  const estimator::fdi::EstimatedValue values[] = {{"b1", 2e-4, 1e-6, 1.9e-4, 2.1e-4}};
  estimator::fdi::EstimateEvent event{};
  event.source = "period";
  event.valid = true;
  event.begin_values = std::begin(values);
  event.end_values = std::end(values);
  publisher.estimate(event, {7'000'000, 0});
  EXPECT_EQ(peer.line_with("b1/std_error"), "True 7.0 /estimate/period/b1/std_error 1e-06");
  estimator::fdi::Alarm alarm;
  alarm.source = "period";
  alarm.name = "b1_low";
  alarm.active = true;
  publisher.alarm(alarm, false, {7'500'000, 0});
  EXPECT_EQ(peer.line_with("active"), "True 7.5 /alarm/period/b1_low/active True");

  bridge.signal(SIGINT);
  EXPECT_THAT(bridge.line_with("datagrams sent"), HasSubstr(" 0 not sent"));
  EXPECT_EQ(bridge.exit_code(), 0);
}

TEST(Bridge, LeavesOutSamplesAboveTheRateAskedFor) {
  Subprocess peer({"python3", SPOOLWATCH_SOURCE_DIR "/tests/workbench/exchange/udp_peer.py"});
  const std::string port = peer.line_with("port");
  ASSERT_FALSE(port.empty());
  const std::string url = own_url();
  Publisher publisher({.url = url}, 3, 0.005, nullptr);
  Subprocess bridge({kProgram, "bridge", "--lcm-url", url, "--udp", "127.0.0.1:" + port.substr(5),
                     "--sample-rate", "50"});
  ASSERT_FALSE(
      line_after(peer, "/sample/tick", [&](int i) { send_sample(publisher, 4 * i); }).empty());
  // 200 Hz in, 50 Hz out: every fourth.
  for (int tick = 10'000; tick < 10'020; ++tick) send_sample(publisher, tick);
  for (int tick = 10'000; tick < 10'020; tick += 4) {
    const std::string line = peer.line_with("/sample/tick 1");
    EXPECT_THAT(line, testing::EndsWith("tick " + std::to_string(tick)));
  }
}

TEST(Bridge, SendsPressuresAndRodSensorsWithTheSamplesThatItSends) {
  Subprocess peer({"python3", SPOOLWATCH_SOURCE_DIR "/tests/workbench/exchange/udp_peer.py"});
  const std::string port = peer.line_with("port");
  ASSERT_FALSE(port.empty());
  const std::string url = own_url();
  Publisher publisher({.url = url}, 3, 0.005, nullptr);
  publisher.enable_pressures();
  publisher.name_rods({"rod", "outer"});
  Subprocess bridge({kProgram, "bridge", "--lcm-url", url, "--udp", "127.0.0.1:" + port.substr(5),
                     "--sample-rate", "50"});
  const auto send = [&](int tick) {
    config::signals::Sample sample;
    sample.tick = tick;
    sample.y_m = 0.125;
    sample.pressures = {7e6, 4e6 + tick, 2e6};
    sample.rod_count = 2;
    sample.rod_in_charge = 1;
    sample.rod_m[0] = 0.5;
    sample.rod_m[1] = 0.125;
    publisher.sample(sample);
  };
  ASSERT_FALSE(line_after(peer, "/pressures/tick", [&](int i) { send(4 * i); }).empty());
  EXPECT_THAT(peer.line_with("/sample/y_m"), HasSubstr("0.125")) << "after what goes with it";
  for (int tick = 10'000; tick < 10'008; ++tick) send(tick);
  EXPECT_THAT(peer.line_with("/rods/in_charge"), testing::EndsWith(" outer"));
  for (const int tick : {10'000, 10'004}) {
    EXPECT_THAT(peer.line_with("/pressures/pressure_in_Pa 401"),
                testing::EndsWith(" " + std::to_string(4'000'000 + tick) + ".0"));
  }
}

TEST(Bridge, CountsWhatNobodyTakes) {
  const std::string url = own_url();
  Publisher publisher({.url = url}, 3, 0.005, nullptr);
  // A port that was free a moment ago.
  const int closed = ::socket(AF_INET6, SOCK_DGRAM, 0);
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  address.sin6_addr = in6addr_loopback;
  socklen_t length = sizeof address;
  if (::bind(closed, reinterpret_cast<sockaddr*>(&address), length) != 0) GTEST_SKIP() << "no IPv6";
  ::getsockname(closed, reinterpret_cast<sockaddr*>(&address), &length);
  ::close(closed);
  Subprocess bridge({kProgram, "bridge", "--lcm-url", url, "--udp",
                     "[::1]:" + std::to_string(ntohs(address.sin6_port))});
  const std::string line =
      line_after(bridge, "nothing takes datagrams", [&](int i) { send_sample(publisher, i); });
  EXPECT_THAT(line, HasSubstr("Connection refused"));
  bridge.signal(SIGTERM);
  EXPECT_THAT(bridge.line_with("datagrams sent"), testing::Not(HasSubstr(" 0 not sent")));
  EXPECT_EQ(bridge.exit_code(), 0);
}

TEST(UdpAddress, TakesNamesAndBothKindsOfNumbers) {
  using exchange::udp_address;
  EXPECT_EQ(udp_address("stand-pc:9870").host, "stand-pc");
  EXPECT_EQ(udp_address("127.0.0.1:9870").port, "9870");
  EXPECT_EQ(udp_address("[fe80::1]:9870").host, "fe80::1");
  for (const char* wrong : {"", "host", "host:", ":9870", "host:0", "host:65536", "host:98x",
                            "::1:9870", "[]:9870", "host:-1"}) {
    EXPECT_THROW((void)udp_address(wrong), config::schema::Error) << wrong;
  }
}

}  // namespace
}  // namespace workbench::exchange
