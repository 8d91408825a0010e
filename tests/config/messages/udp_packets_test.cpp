// LCM's UDP packets: as liblcm sends them, and as nobody should.
#include "config/messages/udp_packets.h"

#include <gmock/gmock.h>

#include <random>

#include "config/messages/plausible.h"
#include "config/messages/udp_receiver.h"
#include "config/schema/error.h"
#include "spoolwatch/sample_t.hpp"

namespace config::messages {
namespace {

std::string number(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

struct Fragment {
  std::uint32_t message = 7;
  std::uint32_t size = 10;
  std::uint32_t offset = 0;
  std::uint32_t index = 0;
  std::uint32_t count = 2;
  std::string data = "01234";
};

std::string packet(const Fragment& f) {
  std::string text = "LC03" + number(f.message, 4) + number(f.size, 4) + number(f.offset, 4) +
                     number(f.index, 2) + number(f.count, 2);
  if (f.index == 0) text += std::string("channel") + '\0';
  return text + f.data;
}

TEST(PacketReassembler, TakesShortMessages) {
  PacketReassembler packets;
  const std::string wire = "LC02" + number(1, 4) + "SPOOLWATCH_ALARM" + '\0' + "payload";
  const auto message = packets.add(1, wire);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "SPOOLWATCH_ALARM");
  EXPECT_EQ(message->payload, "payload");
  EXPECT_EQ(packets.refused(), 0);
}

TEST(PacketReassembler, JoinsFragmentsInAnyOrderAndOfSeveralSenders) {
  PacketReassembler packets;
  const Fragment first;
  const Fragment second{7, 10, 5, 1, 2, "56789"};
  EXPECT_FALSE(packets.add(1, packet(second)));
  EXPECT_FALSE(packets.add(2, packet(first)));
  const auto one = packets.add(1, packet(first));
  const auto two = packets.add(2, packet(second));
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->payload, "0123456789");
  EXPECT_EQ(two->payload, "0123456789");
  EXPECT_EQ(two->channel, "channel");
}

TEST(PacketReassembler, RefusesWhatDoesNotFit) {
  constexpr std::uint32_t kHuge = 0xFFFFFFF0;
  const Fragment wrong[] = {{7, 10, kHuge, 1, 2, "56789"}, {7, kHuge, kHuge, 1, 2, "56789"},
                            {7, 10, 6, 1, 2, "56789"},     {7, 0, 0, 1, 2, ""},
                            {7, 10, 5, 2, 2, "56789"},     {7, 10, 5, 1, 0, "56789"},
                            {7, 10, 5, 1, 60000, "56789"}, {7, 4, 0, 0, 1, "56789"}};
  for (const Fragment& fragment : wrong) {
    PacketReassembler packets;
    EXPECT_FALSE(packets.add(1, packet(fragment)));
    EXPECT_EQ(packets.refused(), 1) << fragment.size << ' ' << fragment.offset;
  }
  PacketReassembler packets;
  EXPECT_FALSE(packets.add(1, packet({})));
  EXPECT_FALSE(packets.add(1, packet({}))) << "the same fragment twice";
  EXPECT_FALSE(packets.add(1, packet({7, 11, 5, 1, 2, "56789"}))) << "another size";
  for (const std::string& text : {std::string(), std::string("LC02"), std::string(3000, 'x'),
                                  "LC02" + number(1, 4) + std::string(64, 'c') + '\0'}) {
    EXPECT_FALSE(packets.add(1, text));
  }
}

// Sums of sizes and offsets beyond every buffer, with the bounds of memory that the header states.
TEST(PacketReassembler, SurvivesAHundredThousandDamagedPackets) {
  std::minstd_rand engine(5);
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  const std::uint32_t edges[] = {0, 1, 5, 10, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  PacketReassembler packets;
  for (int i = 0; i < 100000; ++i) {
    Fragment f{random() % 20, edges[random() % 7], edges[random() % 7],
               random() % 3,  random() % 3,        std::string(random() % 30, 'd')};
    std::string wire = packet(f);
    if (random() % 4 == 0) wire.resize(random() % (wire.size() + 1));
    if (random() % 2 == 0 && !wire.empty()) {
      wire[random() % wire.size()] = static_cast<char>(random());
    }
    const auto message = packets.add(random() % 3, wire);
    if (message) {
      EXPECT_LE(message->payload.size(), PacketReassembler::kMostBytes);
    }
  }
  EXPECT_GT(packets.refused(), 0);
}

TEST(UdpReceiver, RefusesAWrongUrlInOneLine) {
  for (const char* url : {"udpm://127.0.0.1:7667", "udpm://239.255.76.67:x", "udpm://a:1",
                          "udpm://239.255.76.67:70000?ttl=0"}) {
    try {
      const UdpReceiver receiver(url, [](const std::string&) { return true; });
      FAIL() << url;
    } catch (const schema::ConfigError& e) {
      EXPECT_THAT(e.what(),
                  testing::StartsWith(std::string("LCM URL \"") + url + "\": LCM cannot"));
    }
  }
}

TEST(Plausible, RefusesSampleTimesAndTicksThatNoDaemonSends) {
  spoolwatch::sample_t sample{};
  sample.sample_time_s = 0.005;
  sample.y_m = 0.3;
  EXPECT_TRUE(plausible(sample));
  sample.y_m = std::nan("");
  EXPECT_TRUE(plausible(sample)) << "missing, not wrong";
  for (const double time_s : {300.0, 1e-300, 0.0, -0.005, std::nan(""), HUGE_VAL, 1e9}) {
    sample.sample_time_s = time_s;
    EXPECT_FALSE(plausible(sample)) << time_s;
  }
  sample.sample_time_s = 0.005;
  for (const std::int64_t tick : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
    sample.tick = tick;
    EXPECT_FALSE(plausible(sample));
  }
}

}  // namespace
}  // namespace config::messages
