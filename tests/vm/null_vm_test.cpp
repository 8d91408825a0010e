// Null on a real kernel, whatever fails: the rod's encoder, e-stop, enable and permit on lines of a
// GPIO chip, the valve on a comedi board. Each failure is caused, the board's terminal is watched
// from another process, and what was measured is held against what `--check` states. Times are the
// machine's own: it counts instructions, so that a busy host does not make it slow.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>

#include "tests/daemon/program/subprocess.h"
#include "tests/vm/null_rig.h"

namespace {

using program::Measured;
using ::testing::ContainsRegex;

constexpr double kFar_V = 2.0;
/// As the tick before is up to 5 ms older: 50 ms between the two at least.
constexpr std::int64_t kOutage_ns = 47'000'000;

std::string chip() { return std::getenv("SPOOLWATCH_GPIO_CHIP"); }

/// `action`: of the guards.
std::string configuration(const std::string& action) {
  return R"(
schema_version = 1
[rig]
id = "vm"
[loop]
rate_hz = 200.0
auto_arm = true
max_lost_in_a_row = 5
[rod]
backend = "encoder"
[[input]]
id = "e_stop"
role = "e_stop"
backend = "encoder"
channel = "e_stop"
[[input]]
id = "enable"
role = "enable"
backend = "encoder"
channel = "enable"
[permit]
backend = "encoder"
channel = "permit"
[valve]
backend = "comedi"
null_V = 0.25
limit_V = 5.0
[encoder]
line_a = 2
line_b = 3
resolution_m = 1e-4
max_edges_per_s = 1e5
chip = ")" +
         chip() + "\"\nreference_m = " +
         std::to_string(plant_sim::make_plant(plant_sim::ModelFile())->reading_m()) + R"(
[[encoder.input]]
name = "e_stop"
line = 6
[[encoder.input]]
name = "enable"
line = 7
[[encoder.output]]
name = "permit"
line = 8
[comedi]
bench_rig = true
max_speed_mps = 0.25
[comedi.output]
channel = 0
[reference]
kind = "sine"
centre_m = 0.305
amplitude_m = 0.02
frequency_Hz = 1.0
[controller]
kp_V_per_m = 200.0
[safety]
ramp_s = 0.1
[[guard]]
kind = "frozen"
least_m = 2e-4
command_V = 0.5
time_s = 0.05
action = ")" +
         action + "\"\n[[guard]]\nkind = \"e_stop\"\naction = \"" + action + "\"\n";
}

/// All that a failure can be caused with.
struct Stand {
  explicit Stand(const std::string& action) : e_stop(chip(), 6), enable(chip(), 7) {
    e_stop.set(true);
    enable.set(true);
    rig = std::make_unique<vm::NullRig>(chip());
    std::ofstream(file()) << configuration(action);
  }
  [[nodiscard]] std::string file() const { return (folder.path() / "rig.toml").string(); }
  [[nodiscard]] std::vector<std::string> words(const char* more) const {
    return {"--config", file(), "--lcm-url", "", more};
  }

  program::Folder folder;
  hal::hil_rig::SimLine e_stop;
  hal::hil_rig::SimLine enable;
  std::unique_ptr<vm::NullRig> rig;
};

struct Failure {
  const char* row;
  std::function<void(Stand&, program::Daemon&)> cause;
  bool goes_on = false;  ///< after kOutage_ns
  const char* action = "latch";
};

std::vector<Failure> failures() {
  return {{"stop, signal or error", [](Stand&, auto& d) { kill(d.pid(), SIGTERM); }},
          {"loop late, then back", [](Stand&, auto& d) { kill(d.pid(), SIGSTOP); }, true},
          {"enable lost", [](Stand& s, auto&) { s.enable.set(false); }},
          {"guard e_stop", [](Stand& s, auto&) { s.e_stop.set(false); }},
          {"guard frozen", [](Stand& s, auto&) { s.rig->hold_lines(); }},
          {"guard e_stop", [](Stand& s, auto&) { s.e_stop.set(false); }, false, "ramp"},
          {"guard frozen", [](Stand& s, auto&) { s.rig->hold_lines(); }, false, "ramp"}};
}

struct Trial {
  Measured measured{};
  double longer_s = 0.0;  ///< than the outage that was wanted
  std::vector<program::Look> looks;
  double relay_s = 0.0;  ///< until the relay opened; 0: it has not
};

Trial attempt(const Failure& failure) {
  Stand stand(failure.action);
  program::Daemon daemon(stand.words("--duration=60"));
  Trial trial;
  EXPECT_TRUE(stand.rig->moves(kFar_V)) << failure.row << ": no motion";
  const std::int64_t begin_ns = hal::monotonic_ns();
  failure.cause(stand, daemon);
  const std::int64_t begun_ns = hal::monotonic_ns();
  if (failure.goes_on) {
    vm::sleep_until(begin_ns + kOutage_ns);
    kill(daemon.pid(), SIGCONT);
    trial.longer_s = 1e-9 * static_cast<double>(hal::monotonic_ns() - begin_ns - kOutage_ns);
  }
  vm::sleep_until(hal::monotonic_ns() + vm::kSecond_ns / 2);
  trial.looks = stand.rig->looks();
  trial.measured = program::measure(trial.looks, begin_ns, begun_ns, false);
  if (const std::int64_t opened_ns = stand.rig->relay_opened_ns(); opened_ns != 0) {
    trial.relay_s = 1e-9 * static_cast<double>(opened_ns - begin_ns);
  }
  kill(daemon.pid(), SIGCONT);
  kill(daemon.pid(), SIGTERM);
  daemon.wait();
  return trial;
}

std::string table(const char* action = "latch") {
  const Stand stand(action);
  const program::Result check = program::run(stand.words("--check"));
  EXPECT_EQ(check.exit_code, 0) << check.err;
  return check.out;
}

TEST(NullVm, OfEncoderAndBoardIsNeverWorseThanStated) {
  const std::map<std::string, std::string> tables{{"latch", table()}, {"ramp", table("ramp")}};
  std::printf("# %-24s %-8s %-6s %14s %16s %20s %16s\n", "failure", "valve", "action",
              "stated (ms)", "measured (ms)", "stated travel (mm)", "measured (mm)");
  for (const Failure& failure : failures()) {
    const std::string& printed = tables.at(failure.action);
    const program::Stated row = program::stated(printed, failure.row);
    ASSERT_GT(row.time_s, 0.0) << failure.row << "\n" << printed;
    const Trial trial = attempt(failure);
    const Measured& measured = trial.measured;
    ASSERT_FALSE(std::isnan(measured.most_s)) << failure.row << ": never at null";
    const bool guarded = std::string(failure.row).starts_with("guard ");
    std::printf("# %-24s %-8s %-6s %14.1f %7.1f to %5.1f %20.2f %16.2f\n", failure.row, "comedi",
                guarded ? failure.action : "-", row.time_s * 1e3, measured.least_s * 1e3,
                measured.most_s * 1e3, row.travel_m * 1e3, measured.travel_m * 1e3);
    EXPECT_LE(measured.least_s, row.time_s + trial.longer_s) << failure.row;
    EXPECT_LE(measured.travel_m, row.travel_m * (1.0 + trial.longer_s / row.time_s)) << failure.row;
    const auto null_again = [](const program::Look& look) {
      return std::abs(look.valve_V) < program::kNull_V;
    };
    EXPECT_TRUE(null_again(trial.looks.back())) << failure.row << ": the law went on";
  }
}

// A board keeps its last code when nobody writes any more, as the table says: the permit line
// rests, and the relay that it keeps closed opens after the time that it is set to. Of a process
// that is killed the kernel gives the line back, which may be one more edge, once it has taken it
// apart.
TEST(NullVm, OfABoardWhoseDaemonIsKilledOrStoppedIsThePermitsRelay) {
  const std::string printed = table();
  const struct {
    const char* row;
    int number;
    double more_s;
  } ends[] = {{"process killed", SIGKILL, 0.03}, {"process stopped", SIGSTOP, 0.0}};
  for (const auto& [row, number, more_s] : ends) {
    EXPECT_THAT(printed,
                ContainsRegex(std::string(row) + " +comedi +never +- +.the permit's relay"));
    const int signal = number;
    const Trial trial = attempt({row, [signal](Stand&, auto& d) { kill(d.pid(), signal); }});
    EXPECT_TRUE(std::isnan(trial.measured.most_s)) << row << ": somebody wrote null";
    EXPECT_GT(trial.looks.back().valve_V, kFar_V - 0.5) << "the board keeps its code";
    ASSERT_GT(trial.relay_s, 0.0) << row << ": the permit goes on";
    std::printf("# %-24s %-8s %-6s %14s %7.1f (relay of %.0f ms)\n", row, "comedi", "-", "never",
                trial.relay_s * 1e3, 1e-6 * static_cast<double>(vm::kRelay_ns));
    // Two steps of the rig.
    EXPECT_LT(trial.relay_s, 1e-9 * static_cast<double>(vm::kRelay_ns) + more_s + 0.002) << row;
  }
}

}  // namespace
