// hal/comedi on a real kernel: the board of comedi_test, whose analogue inputs (subdevice 0) give
// back what its analogue outputs (subdevice 1) were given.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/comedi/comedi.h"

namespace hal::comedi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

BackendDevices open(const std::string& text, double null_V = 0.0, double limit_V = 10.0) {
  ComediBackend backend;
  config::schema::Document::parse("schema_version = 1\n" + text, "rig.toml").read([&](auto& v) {
    backend.visit(v);
  });
  return backend.open({"rig.toml", ".", 0.005, null_V, limit_V});
}

std::string complaint(const std::string& text, double null_V = 0.0, double limit_V = 10.0) {
  try {
    open(text, null_V, limit_V);
  } catch (const config::schema::Error& e) {
    return e.what();
  }
  return "nothing";
}

/// Calls `read` until it gives `expected` within `tolerance`, for at most 10 s; its last value.
template <class Read>
double until(Read read, double expected, double tolerance) {
  double value = read();
  for (int i = 0; i < 1000 && !(std::abs(value - expected) <= tolerance); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    value = read();
  }
  return value;
}

constexpr double kStep_V = 20.0 / 65'535.0;  // range 0 of the board: 16 bits over +-10 V

class ComediVm : public ::testing::TestWithParam<const char*> {};

TEST_P(ComediVm, WhatIsWrittenToTheOutputIsReadBackAtTheInput) {
  const BackendDevices devices =
      open(std::string(GetParam()) +
           "[output]\nchannel = 2\npolarity = -1\nscale_ratio = 0.5\n"
           "offset_V = 0.1\n[rod]\nchannel = 2\nscale_m_per_V = 0.02\n"
           "offset_m = 0.3\n[[input]]\nname = \"command\"\nchannel = 2\n");
  Tick tick;
  for (const double u_V : {0.0, 3.3, -7.7, 10.0, -10.0}) {
    const Applied applied = devices.valve->write(u_V, tick);
    EXPECT_NEAR(applied.u_V, u_V, kStep_V);
    const double terminal_V = 0.1 - 0.5 * u_V;
    const auto read_V = [&] {
      ++tick.index;
      return devices.inputs.at("command")->read(tick).value;
    };
    EXPECT_NEAR(until(read_V, terminal_V, kStep_V), terminal_V, kStep_V);
    EXPECT_NEAR(devices.rods.at(kRodChannel)->read(tick).y_m, 0.3 + 0.02 * terminal_V,
                0.02 * kStep_V);
    EXPECT_EQ(devices.rods.at(kRodChannel)->read(tick).quality, config::signals::Quality::good);
    EXPECT_TRUE(devices.valve->write(u_V, tick).good);
  }
}

TEST_P(ComediVm, GoesToNullWithoutTheThread) {
  const BackendDevices devices =
      open(std::string(GetParam()) +
               "[output]\nchannel = 1\n[[input]]\nname = \"command\"\nchannel = 1\n",
           0.4, 5.0);
  Tick tick;
  devices.valve->write(4.0, tick);
  EXPECT_TRUE(devices.valve->go_null().good);
  const auto read_V = [&] {
    ++tick.index;
    return devices.inputs.at("command")->read(tick).value;
  };
  EXPECT_NEAR(until(read_V, 0.4, kStep_V), 0.4, kStep_V);
}

INSTANTIATE_TEST_SUITE_P(Threaded, ComediVm,
                         ::testing::Values("threaded = true\n", "threaded = false\n"));

TEST(ComediVmRefuses, WhatTheBoardDoesNotHave) {
  EXPECT_THAT(complaint("device = \"/dev/comedi1\"\n"),
              AllOf(HasSubstr("[comedi] device"), HasSubstr("/dev/comedi1")));
  EXPECT_THAT(complaint("[output]\nsubdevice = 0\n"),
              AllOf(HasSubstr("[comedi.output] subdevice"), HasSubstr("no analogue output"),
                    HasSubstr("1 of comedi_test")));
  EXPECT_THAT(complaint("[output]\nsubdevice = 7\n"), HasSubstr("is 7, which is no analogue"));
  EXPECT_THAT(complaint("[output]\nchannel = 8\n"),
              AllOf(HasSubstr("[comedi.output] channel"), HasSubstr("channels 0 to 7")));
  EXPECT_THAT(complaint("[[input]]\nname = \"p\"\nrange = 2\n"),
              AllOf(HasSubstr("[[comedi.input]] 1 range"), HasSubstr("ranges 0 to 1")));
  EXPECT_THAT(complaint("[rod]\nkind = \"counter\"\nresolution_m = 1e-5\n"),
              AllOf(HasSubstr("[comedi.rod] subdevice"), HasSubstr("counters")));
}

TEST(ComediVmRefuses, ARangeThatDoesNotReachNullAndLimit) {
  EXPECT_THAT(complaint("[output]\nrange = 1\n"),
              AllOf(HasSubstr("[comedi.output] range"), HasSubstr("-5 to 5 V"),
                    HasSubstr("command of -10 V")));
  EXPECT_EQ(complaint("[output]\nrange = 1\n", 0.0, 5.0), "nothing");
  EXPECT_EQ(complaint("[output]\nrange = 1\nscale_ratio = 0.5\n"), "nothing");
  EXPECT_THAT(complaint("[output]\n", 0.4, 10.0), HasSubstr("command of 10.4 V"));
}

TEST(ComediVmRefuses, AnOutputThatAnotherProgramDrives) {
  const BackendDevices devices = open("[output]\nchannel = 0\n");
  EXPECT_THAT(complaint("[output]\nchannel = 1\n"), HasSubstr("another program has locked"));
}

}  // namespace
}  // namespace hal::comedi
