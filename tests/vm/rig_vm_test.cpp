// The bench on a real kernel: spoolwatch-rig moves the lines of a GPIO chip and takes the valve's
// command over Modbus, spoolwatchd reads the one and writes the other.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/hal/hil_rig/rig_process.h"

namespace {

using ::testing::HasSubstr;

constexpr double kCount_m = 1e-4;
constexpr double kStart_m = 0.305;  // half the stroke, where the model begins
constexpr double kAmplitude_m = 0.012;
constexpr double kPressed_s = 5.0;
constexpr double kEnd_s = 7.0;
constexpr int kLatched = 4;

std::string chip() { return std::getenv("SPOOLWATCH_GPIO_CHIP"); }

std::vector<std::string> rig_arguments() {
  std::vector<std::string> words{"--config", "bench_rig.toml"};
  for (const std::string& setting :
       {std::string("sim.model=thesis_calibrated.toml"), std::string("gpio.chip=") + chip(),
        std::string("gpio.line_a=2"), std::string("gpio.line_b=3"),
        std::string("gpio.line_index=4"), std::string("gpio.line_e_stop=6"),
        // gpio-sim forgets an edge of a line whose interrupt thread is still at the last one: the
        // rig must not come before it
        std::string("bus.priority=0"), "gpio.count_m=" + std::to_string(kCount_m)}) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  return words;
}

/// bench_modbus.toml with the rod and the e-stop on GPIO lines.
std::string mixed_configuration(const std::string& address) {
  std::ifstream in("bench_modbus.toml");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("backend = \"modbus\"\nchannel = \"position\"", "backend = \"encoder\"");
  replace("role = \"e_stop\"\nbackend = \"modbus\"", "role = \"e_stop\"\nbackend = \"encoder\"");
  replace("127.0.0.1:1502", address);
  return text + "[encoder]\nchip = \"" + chip() +
         "\"\nline_a = 2\nline_b = 3\nline_index = 4\nmax_edges_per_s = 1e5\nresolution_m = " +
         std::to_string(kCount_m) + "\nreference_m = " + std::to_string(kStart_m) +
         "\n[[encoder.input]]\nname = \"e_stop\"\nline = 6\n";
}

TEST(RigVm, MovesTheLinesAsTheValveIsToldOverModbusUntilItsEmergencyStopIsPressed) {
  const hal::hil_rig::RigProcess rig(rig_arguments());
  ASSERT_FALSE(rig.address().empty());
  const program::Folder folder;
  const std::string file = (folder.path() / "rig.toml").string();
  std::ofstream(file) << mixed_configuration(rig.address());
  const auto logs = folder.path() / "logs";
  std::filesystem::create_directory(logs);
  std::vector<std::string> words{"--config", file,         "--lcm-url",
                                 "",         "--duration", std::to_string(kEnd_s)};
  for (const std::string& setting :
       {std::string("modbus.timeout_s=0.2"), std::string("modbus.stale_after_s=0.4"),
        std::string("modbus.watchdog_s=0.5"), std::string("loop.max_bad_in_a_row=80"),
        std::string("loop.overrun_action=count"),
        "reference.amplitude_m=" + std::to_string(kAmplitude_m),
        "recorder.folder=" + logs.string()}) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  program::Daemon daemon(words);
  std::this_thread::sleep_for(std::chrono::duration<double>(kPressed_s));
  ASSERT_EQ(hal::hil_rig::run_rig({"set", "--address", rig.address(), "e_stop=0"}).exit_code, 0);
  const program::Result result = daemon.wait();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::printf("%s", result.err.c_str());
  EXPECT_THAT(result.err, HasSubstr("count uncertain 0 times"));
  const program::Log log = program::read_log(logs);
  double low_m = 1.0;
  double high_m = 0.0;
  for (const auto& sample : log.samples) {
    if (std::isnan(sample.y_m)) continue;
    low_m = std::min(low_m, sample.y_m);
    high_m = std::max(high_m, sample.y_m);
  }
  // The reference, followed by a loop with a pole at 250 V/m times 0.039 m/s per V.
  EXPECT_NEAR(high_m - low_m, 2.0 * kAmplitude_m * 0.95, 0.004);
  ASSERT_FALSE(log.samples.empty());
  EXPECT_EQ(log.samples.back().state, kLatched);
  EXPECT_EQ(log.samples.back().u_applied_V, 0.0);
}

}  // namespace
