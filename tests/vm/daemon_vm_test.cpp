// spoolwatchd on a real kernel: the rod's encoder on lines of a GPIO chip, the valve on a comedi
// board, and a rig in a process of its own that takes the board's voltage and moves the lines.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "hal/comedi/board.h"
#include "hal/hil_rig/gpio_lines.h"
#include "plant_sim/model_file.h"
#include "plant_sim/plant.h"
#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/vm/process.h"

namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;

constexpr double kCount_m = 1e-4;
constexpr double kPeriod_s = 0.005;
constexpr double kNull_V = 0.25;
constexpr hal::comedi::ConverterSpan kSpan{-10.0, 10.0, 65'535};
constexpr hal::comedi::BoardChannel kInput{0, 0, 0, 0};
constexpr hal::comedi::BoardChannel kOutput{1, 0, 0, 0};
enum State : int { monitor, disarmed, armed, run, latched };

std::string chip() { return std::getenv("SPOOLWATCH_GPIO_CHIP"); }

/// The rig: every period the plant advances under the board's voltage, and the lines follow.
/// `at_s`: called with the time since it began. Ends by being killed.
class Rig {
 public:
  explicit Rig(const std::function<void(double t_s)>& at_s)
      : process_([at_s] {
          hal::hil_rig::SimEncoder lines(chip(), 2, 3);
          const std::unique_ptr<plant_sim::Plant> plant =
              plant_sim::make_plant(plant_sim::ModelFile());
          hal::comedi::ComediBoard board("rig", "/dev/comedi0");
          const double start_m = plant->reading_m();
          const std::int64_t start_ns = hal::monotonic_ns();
          for (std::int64_t k = 0;; ++k) {
            vm::sleep_until(start_ns + k * std::llround(kPeriod_s * 1e9));
            at_s(static_cast<double>(k) * kPeriod_s);
            const double u_V = kSpan.volts(board.read(kInput).value_or(0)) - kNull_V;
            plant->advance(u_V, kPeriod_s);
            lines.move_to(std::llround((plant->reading_m() - start_m) / kCount_m));
          }
          return 0;
        }) {}

 private:
  vm::Process process_;
};

std::string configuration(const std::string& more) {
  const double start_m = plant_sim::make_plant(plant_sim::ModelFile())->reading_m();
  std::string text = R"(
schema_version = 1
[rig]
id = "vm"
[loop]
rate_hz = 200.0
overrun_action = "count"
AUTO
[rod]
backend = "encoder"
[[input]]
id = "e_stop"
role = "e_stop"
backend = "encoder"
channel = "e_stop"
[encoder]
chip = "CHIP"
line_a = 2
line_b = 3
resolution_m = 1e-4
reference_m = START
max_edges_per_s = 1e5
[[encoder.input]]
name = "e_stop"
line = 6
[[encoder.output]]
name = "permit"
line = 8
)" + more;
  const auto replace = [&](const std::string& from, const std::string& to) {
    if (const auto at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
  };
  replace("CHIP", chip());
  replace("START", std::to_string(start_m));
  replace("AUTO", more.find("[comedi.output]") == std::string::npos ? "" : "auto_arm = ARM");
  return text;
}

constexpr const char* kDriven = R"(
[permit]
backend = "encoder"
channel = "permit"
[valve]
backend = "comedi"
null_V = 0.25
limit_V = 5.0
[comedi]
bench_rig = true
[comedi.output]
channel = 0
[reference]
kind = "sine"
centre_m = 0.305
amplitude_m = 0.01
frequency_Hz = 0.5
[controller]
kp_V_per_m = 200.0
)";

constexpr const char* kWatched = R"(
[valve]
backend = "none"
[[input]]
id = "command"
role = "valve_command"
backend = "comedi"
channel = "command"
[[comedi.input]]
name = "command"
channel = 0
)";

/// Runs the daemon for so long beside what the test has started; its log.
program::Log watch(std::string text, const std::string& auto_arm, double duration_s) {
  const program::Folder folder;
  if (const auto at = text.find("ARM"); at != std::string::npos) text.replace(at, 3, auto_arm);
  const std::string file = (folder.path() / "rig.toml").string();
  std::ofstream(file) << text;
  const auto logs = folder.path() / "logs";
  std::filesystem::create_directory(logs);
  const program::Result result =
      program::run({"--config", file, "--lcm-url", "", "--duration", std::to_string(duration_s),
                    "--set", "recorder.folder=" + logs.string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("count uncertain 0 times"));
  std::printf("%s", result.err.c_str());
  return program::read_log(logs);
}

double volts_now() {
  hal::comedi::ComediBoard board("test", "/dev/comedi0");
  return kSpan.volts(board.read(kInput).value_or(0));
}

TEST(DaemonVm, StandsDisarmedWithTheValveAtNull) {
  hal::hil_rig::SimLine e_stop(chip(), 6);
  e_stop.set(true);
  const Rig rig([](double) {});
  const program::Log log = watch(configuration(kDriven), "false", 2.0);
  ASSERT_GT(log.samples.size(), 100U);
  EXPECT_THAT(log.samples, Each(Field(&spoolwatch::sample_t::state, disarmed)));
  EXPECT_NEAR(volts_now(), kNull_V, 2.0 * kSpan.step_V());
  for (const auto& sample : log.samples) {
    ASSERT_NEAR(sample.y_m, log.samples.front().y_m, 2.0 * kCount_m);
  }
}

TEST(DaemonVm, MovesTheRodAndTripsOnTheEmergencyStop) {
  hal::hil_rig::SimLine e_stop(chip(), 6);
  e_stop.set(true);
  const Rig rig([&](double t_s) {
    if (t_s > 6.0) e_stop.set(false);
  });
  const program::Log log = watch(configuration(kDriven), "true", 7.0);
  double low_m = 1.0;
  double high_m = 0.0;
  std::size_t running = 0;
  for (const auto& sample : log.samples) {
    if (sample.state != run) continue;
    ++running;
    low_m = std::min(low_m, sample.y_m);
    high_m = std::max(high_m, sample.y_m);
  }
  EXPECT_GT(running, 300U);
  // 200 V/m times the rig's 0.039 m/s per V: a pole at 7.7 rad/s, 0.93 of a reference of 0.5 Hz.
  EXPECT_NEAR(high_m - low_m, 0.93 * 0.02, 0.004);
  EXPECT_EQ(log.samples.back().state, latched);
  EXPECT_NEAR(log.samples.back().u_applied_V, kNull_V, 2.0 * kSpan.step_V());
  EXPECT_NEAR(volts_now(), kNull_V, 2.0 * kSpan.step_V());
}

TEST(DaemonVm, WatchesARigThatAnotherControllerMovesAndWritesNothing) {
  hal::hil_rig::SimLine e_stop(chip(), 6);
  e_stop.set(true);
  const auto command_V = [](double t_s) {
    return kNull_V + std::sin(2.0 * std::numbers::pi * 0.5 * t_s);
  };
  const auto controller = std::make_shared<hal::comedi::ComediBoard>("test", "/dev/comedi0");
  const Rig rig([&](double t_s) { controller->write(kOutput, kSpan.code(command_V(t_s))); });
  const program::Log log = watch(configuration(kWatched), "", 4.0);
  ASSERT_GT(log.samples.size(), 200U);
  EXPECT_THAT(log.samples, Each(Field(&spoolwatch::sample_t::state, monitor)));
  double u_low_V = 10.0;
  double u_high_V = -10.0;
  double path_m = 0.0;
  for (std::size_t i = 1; i < log.samples.size(); ++i) {
    u_low_V = std::min(u_low_V, log.samples[i].u_applied_V);
    u_high_V = std::max(u_high_V, log.samples[i].u_applied_V);
    path_m += std::abs(log.samples[i].y_m - log.samples[i - 1].y_m);
  }
  EXPECT_NEAR(u_low_V, kNull_V - 1.0, 0.01);
  EXPECT_NEAR(u_high_V, kNull_V + 1.0, 0.01);
  EXPECT_GT(path_m, 0.01);
}

}  // namespace
