// How values are laid out in registers, and which maps are refused.
#include "hal/modbus/registers.h"

#include <gmock/gmock.h>

#include <array>

#include "hal/modbus/command_slot.h"
#include "hal/modbus/jitter_check.h"
#include "tests/hal/modbus/stand.h"

namespace hal::modbus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Codec codec(const std::string& type, const std::string& order, double scale = 1.0,
            double offset = 0.0) {
  Register r;
  r.type = type;
  r.order = order;
  r.scale = scale;
  r.offset = offset;
  return Codec(r);
}

std::vector<int> wire(const Codec& c, double value) {
  std::array<std::uint16_t, 2> words{};
  c.store(c.encode(value), words.data());
  std::vector<int> all(words.begin(), words.begin() + c.words());
  return all;
}

// 1.0 is 3F 80 00 00 in IEEE 754, 0x01020304 its four bytes in order.
TEST(Codec, LaysOutTheFourByteOrders) {
  EXPECT_THAT(wire(codec("float32", "ABCD"), 1.0), ElementsAre(0x3F80, 0x0000));
  EXPECT_THAT(wire(codec("float32", "CDAB"), 1.0), ElementsAre(0x0000, 0x3F80));
  EXPECT_THAT(wire(codec("float32", "BADC"), 1.0), ElementsAre(0x803F, 0x0000));
  EXPECT_THAT(wire(codec("float32", "DCBA"), 1.0), ElementsAre(0x0000, 0x803F));
  EXPECT_THAT(wire(codec("int32", "ABCD"), 0x01020304), ElementsAre(0x0102, 0x0304));
  EXPECT_THAT(wire(codec("int32", "CDAB"), 0x01020304), ElementsAre(0x0304, 0x0102));
  EXPECT_THAT(wire(codec("int32", "BADC"), 0x01020304), ElementsAre(0x0201, 0x0403));
  EXPECT_THAT(wire(codec("int32", "DCBA"), 0x01020304), ElementsAre(0x0403, 0x0201));
  EXPECT_THAT(wire(codec("int16", "ABCD"), -2), ElementsAre(0xFFFE));
  EXPECT_THAT(wire(codec("int16", "DCBA"), -2), ElementsAre(0xFEFF));
  EXPECT_THAT(wire(codec("uint32", "ABCD"), 4294967295.0), ElementsAre(0xFFFF, 0xFFFF));
}

TEST(Codec, SetsUnitAndSignByScaleAndOffset) {
  const Codec c = codec("int16", "ABCD", -0.005, 2.5);  // 2.5 V at raw 0, the other way round
  EXPECT_THAT(wire(c, 2.5), ElementsAre(0));
  EXPECT_THAT(wire(c, 2.0), ElementsAre(100));
  EXPECT_DOUBLE_EQ(c.decode(100), 2.0);
  EXPECT_DOUBLE_EQ(c.decode(0xFFFF), 2.505);
}

TEST(Codec, ClampsToItsTypeAndItsLimits) {
  EXPECT_THAT(wire(codec("int16", "ABCD"), 1e9), ElementsAre(0x7FFF));
  EXPECT_THAT(wire(codec("int16", "ABCD"), -1e9), ElementsAre(0x8000));
  EXPECT_THAT(wire(codec("uint16", "ABCD"), -1.0), ElementsAre(0));
  EXPECT_THAT(wire(codec("int32", "ABCD"), 1e12), ElementsAre(0x7FFF, 0xFFFF));
  Register r;
  r.type = "float32";
  r.low = -5.0;
  r.high = 10.0;
  EXPECT_EQ(Codec(r).decode(Codec(r).encode(-7.0)), -5.0);
  EXPECT_EQ(Codec(r).decode(Codec(r).encode(11.0)), 10.0);
  EXPECT_FALSE(Codec(r).plausible(11.0));
  EXPECT_FALSE(Codec(r).plausible(kMissing));
  EXPECT_TRUE(Codec(r).plausible(-5.0));
}

TEST(CommandSlot, KeepsTheNewestCommandAndItsTime) {
  CommandSlot box;
  EXPECT_FALSE(box.take(0).has_value());
  for (const std::int64_t t_ns :
       {std::int64_t{5'000'000}, std::int64_t{1} << 47, (std::int64_t{1} << 48) + 123'456'789}) {
    box.put(1, t_ns - 5'000'000);
    box.put(0xFFFFFFFF, t_ns);
    const auto command = box.take(t_ns + 3'000'000);
    ASSERT_TRUE(command.has_value());
    EXPECT_EQ(command->bits, 0xFFFFFFFFU);
    EXPECT_NEAR(static_cast<double>(command->t_ns - t_ns), 0.0, 131'072.0);
    EXPECT_FALSE(box.take(t_ns + 3'000'000).has_value());
  }
}

// A command given before the clock has wrapped, taken after.
TEST(CommandSlot, KnowsTheAgeOfACommandAcrossTheWrapOfItsStamp) {
  CommandSlot box;
  const std::int64_t wrap_ns = std::int64_t{1} << 48;
  box.put(7, wrap_ns - 1'000'000);
  const auto command = box.take(wrap_ns + 2'000'000);
  ASSERT_TRUE(command.has_value());
  EXPECT_NEAR(static_cast<double>(command->t_ns - (wrap_ns - 1'000'000)), 0.0, 131'072.0);
}

// Readings every 5 ms, 1.5 ms before their tick; times in us.
TEST(JitterCheck, KeepsReadingsOfTheUsualMomentOnly) {
  JitterCheck phase(500'000);
  const auto accepts = [&](std::int64_t t_us, std::int64_t tick) {
    return phase.accepts(t_us * 1000, tick * 5'000'000);
  };
  EXPECT_TRUE(accepts(98'500, 0)) << "the first one sets it";
  EXPECT_TRUE(accepts(103'600, 1));
  EXPECT_FALSE(accepts(103'600, 2)) << "handed out before";
  EXPECT_FALSE(accepts(114'600, 3)) << "1.1 ms late";
  EXPECT_TRUE(accepts(118'500, 4));
  EXPECT_FALSE(accepts(123'500, 7)) << "of a tick that was skipped";
  for (int tick = 8; tick < 11; ++tick) EXPECT_FALSE(accepts(100'000 + 5000 * tick, tick));
  EXPECT_TRUE(accepts(155'000, 11)) << "a new habit";
  EXPECT_TRUE(accepts(160'000, 12));
}

const std::string kAddress = "address = \"127.0.0.1:9\"\n";

std::string entry(const std::string& name, const std::string& text) {
  return "[modbus.registers." + name + "]\n" + text + "\n";
}

TEST(RegisterMap, RefusesWhatOverlapsOverflowsOrIsOutOfOrder) {
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=4\ntype=\"float32\"") +
                         entry("b", "role=\"input\"\naddress=5")),
              HasSubstr("[modbus.registers.b] address: is 5, which overlaps [modbus.registers.a]"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=65535\ntype=\"float32\"")),
              HasSubstr("[modbus.registers.a] address: is 65535, and a float32 there ends past"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=65536")),
              HasSubstr("[modbus.registers.a] address"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=1\nlow=2.0\nhigh=1.0")),
              HasSubstr("[modbus.registers.a] low: is not below high"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=1\nscale=0.0")),
              HasSubstr("[modbus.registers.a] scale"));
  EXPECT_THAT(
      refusal_of(kAddress + entry("a", "role=\"valve_command\"\naddress=1\nfunction=\"input\"")),
      HasSubstr("allowed: holding"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"valve_command\"\naddress=1") +
                         entry("b", "role=\"valve_command\"\naddress=2")),
              HasSubstr("one of each"));
  EXPECT_THAT(refusal_of(kAddress + entry("a", "role=\"rod\"\naddress=1\ntype=\"bit\"")),
              HasSubstr("[modbus.registers.a] type"));
  EXPECT_THAT(refusal_of("combined = true\n" + kAddress +
                         entry("a", "role=\"rod\"\naddress=1\nfunction=\"input\"") +
                         entry("b", "role=\"valve_command\"\naddress=2")),
              HasSubstr("[modbus] combined"));
}

TEST(RegisterMap, RefusesWhatTheDeviceWouldNotGet) {
  const std::string valve = entry("u",
                                  "role=\"valve_command\"\naddress=1\ntype=\"int16\"\n"
                                  "scale=0.001\nlow=-1.0\nhigh=1.0");
  EXPECT_THAT(refusal_of(kAddress + valve, 2.0), HasSubstr("[valve] null_V: is 2"));
  // 5 ms in steps of 20 ms would be 0: no time-out at all.
  EXPECT_THAT(refusal_of("watchdog_s = 0.005\n" + kAddress +
                         entry("w", "role=\"watchdog\"\naddress=1\nscale=0.02")),
              HasSubstr("[modbus] watchdog_s: is 0.005"));
  EXPECT_THAT(refusal_of(kAddress + entry("w", "role=\"watchdog\"\naddress=1\nscale=0.001")),
              HasSubstr("[modbus] watchdog_s: is missing for [modbus.registers.w]"));
}

TEST(RegisterMap, RefusesAnAddressThatIsNone) {
  EXPECT_THAT(refusal_of(""), HasSubstr("[modbus] address: is missing"));
  EXPECT_THAT(refusal_of("address = \"rig:502\"\n"), HasSubstr("is \"rig:502\""));
  EXPECT_THAT(refusal_of("address = \"127.0.0.1\"\n"), HasSubstr("a numeric address and a port"));
  EXPECT_THAT(refusal_of("address = \"127.0.0.1:70000\"\n"), HasSubstr("[modbus] address"));
  EXPECT_THAT(refusal_of("serial = \"/dev/ttyS0\"\nbaud = 12345\n"), HasSubstr("[modbus] baud"));
  EXPECT_THAT(refusal_of("serial = \"/dev/no-such-line\"\n"),
              HasSubstr("[modbus] serial \"/dev/no-such-line\""));
  EXPECT_THAT(refusal_of("address = \"127.0.0.1:502\"\nserial = \"/dev/ttyS0\"\n"),
              HasSubstr("[modbus] address: is given together with serial"));
}

}  // namespace
}  // namespace hal::modbus
