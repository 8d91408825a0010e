// Every failure on the bench rig over Modbus, measured at the rig itself by a client of its own:
// how long the valve keeps a command, how far the rod travels. Held against what `--check` states.
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "hal/device_thread.h"
#include "hal/rig/server.h"
#include "tests/daemon/program/bench_watch.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/hal/rig/rig_process.h"

namespace program {
namespace {

/// What is still called null: two steps of the converter.
constexpr double kNull_V = 0.01;
/// A command that is far from null, and moves the rod by some decimetres a second.
constexpr double kFar_V = 3.0;

constexpr const char* kGuards = R"(
[safety]
ramp_s = 0.1

[[guard]]
kind = "jump"
limit_m = 0.008
action = "latch"

[[guard]]
kind = "frozen"
least_m = 5e-5
command_V = 1.0
time_s = 0.05
action = "ramp"
)";

// One at a time: none of the others may come first.
constexpr const char* kTravel = R"(
[[guard]]
kind = "travel"
low_m = 0.2
high_m = 0.42
action = "latch"
)";
constexpr const char* kSpeed = R"(
[[guard]]
kind = "speed"
limit_mps = 1.0
action = "latch"
)";
constexpr const char* kFollowing = R"(
[[guard]]
kind = "following"
limit_m = 0.08
time_s = 0.02
action = "latch"
)";
constexpr const char* kEnable = R"(
[modbus.registers.enable]
role = "input"
address = 12
[[input]]
id = "enable"
role = "enable"
backend = "modbus"
channel = "enable"
)";

constexpr const char* kPermit = R"(
[permit]
backend = "modbus"
channel = "permit"

[modbus.registers.permit]
role = "output"
function = "coil"
address = 0
)";

/// bench_modbus.toml with more, and the shipped daemon on it.
class Bench {
 public:
  explicit Bench(const std::string& more = kGuards)
      : rig_({"--config", hal::rig::shipped_config("bench_rig.toml")}),
        cable_(rig_.port()),
        watcher_(rig_.port()) {
    std::ifstream in(shipped("bench_modbus.toml"));
    std::ofstream(file()) << in.rdbuf() << more;
  }

  [[nodiscard]] std::vector<std::string> arguments(bool by_cable = false) const {
    return {"--config",  file(),
            "--lcm-url", "",
            "--set",     "modbus.address=" + (by_cable ? cable_.address() : rig_.address()),
            "--set",     "reference.amplitude_m=0.05",
            "--set",     "reference.frequency_Hz=1.0"};
  }
  [[nodiscard]] std::string file() const { return (folder_.path() / "bench.toml").string(); }
  /// Until the valve is far from null, and on its way out.
  bool moves() {
    return watcher_.wait_for([](const Look& look) { return look.valve_V > kFar_V; });
  }
  void set(const std::string& text) const {
    EXPECT_EQ(hal::rig::set_remotely(rig_.address(), text), "");
  }
  /// The rig's register of that name, read on a connection of its own.
  [[nodiscard]] int status() const {
    modbus_t* bus = modbus_new_tcp("127.0.0.1", rig_.port());
    std::uint16_t word = 0;
    const bool read =
        modbus_connect(bus) == 0 && modbus_read_registers(bus, hal::rig::kStatus, 1, &word) == 1;
    modbus_close(bus);
    modbus_free(bus);
    return read ? word : 0;
  }
  Watcher& watcher() { return watcher_; }
  Cable& cable() { return cable_; }

 private:
  Folder folder_;
  hal::rig::RigProcess rig_;
  Cable cable_;
  Watcher watcher_;
};

struct Stated {
  double time_s = std::nan("");
  double travel_m = std::nan("");
};

/// The row of `--check`.
Stated stated(const std::string& table, const std::string& failure) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("# " + failure + " ", 0) != 0) continue;
    std::istringstream rest(line.substr(2 + failure.size()));
    std::string backend;
    Stated row;
    rest >> backend >> row.time_s >> row.travel_m;
    return {row.time_s * 1e-3, row.travel_m * 1e-3};
  }
  return {};
}

struct Failure {
  std::string row;
  std::function<void(Bench&, Daemon&)> cause;
  bool device_decides = false;  ///< the machine's load does not matter
  bool at_command = false;      ///< null is looked for in what was written, not at the valve
  bool spoils_reading = false;  ///< so that it does not say how far the rod went
  const char* more = kGuards;   ///< of the configuration
};

struct Measured {
  double least_s;  ///< it was longer than that
  double most_s;   ///< and shorter than that
  double travel_m;
};

Measured measure(const std::vector<Look>& looks, std::int64_t begin_ns, std::int64_t begun_ns,
                 bool at_command) {
  Measured measured{0.0, std::nan(""), 0.0};
  double start_m = std::nan("");
  for (const Look& look : looks) {
    if (look.after_ns < begin_ns) {
      start_m = look.rod_m;
      continue;
    }
    measured.travel_m = std::max(measured.travel_m, std::abs(look.rod_m - start_m));
    const double u_V = at_command ? look.command_V : look.valve_V;
    if (std::abs(u_V) < kNull_V) {
      measured.most_s = static_cast<double>(look.after_ns - begin_ns) * 1e-9;
      return measured;
    }
    measured.least_s = std::max(0.0, static_cast<double>(look.before_ns - begun_ns) * 1e-9);
  }
  return measured;
}

void signal_daemon(Daemon& daemon, int number) { kill(daemon.pid(), number); }

std::vector<Failure> failures() {
  return {
      {"stop, signal or error", [](Bench&, Daemon& d) { signal_daemon(d, SIGTERM); }},
      {"position missing", [](Bench& b, Daemon&) { b.set("encoder_offset_m=50"); }, false, false,
       true},
      {"bus lost", [](Bench& b, Daemon&) { b.cable().cut(); }, true},
      {"process killed", [](Bench&, Daemon& d) { signal_daemon(d, SIGKILL); }, true},
      {"process stopped", [](Bench&, Daemon& d) { signal_daemon(d, SIGSTOP); }, true},
      {"guard e_stop", [](Bench& b, Daemon&) { b.set("e_stop=0"); }, false, true},
      {"guard jump", [](Bench& b, Daemon&) { b.set("encoder_offset_m=0.02"); }, false, false, true},
      {"guard frozen", [](Bench& b, Daemon&) { b.set("encoder_frozen=1"); }, false, false, true},
      {"guard travel", [](Bench& b, Daemon&) { b.set("encoder_offset_m=0.2"); }, false, false, true,
       kTravel},
      {"guard speed", [](Bench& b, Daemon&) { b.set("encoder_offset_m=0.02"); }, false, false, true,
       kSpeed},
      {"guard following", [](Bench& b, Daemon&) { b.set("encoder_offset_m=0.2"); }, false, false,
       true, kFollowing},
      {"enable lost", [](Bench& b, Daemon&) { b.set("enable=0"); }, false, true, false, kEnable},
  };
}

TEST(NullMatrix, OnTheBenchRigOverModbusIsNeverWorseThanStated) {
  std::printf("# %-24s %-8s %14s %16s %20s %16s\n", "failure", "valve", "stated (ms)",
              "measured (ms)", "stated travel (mm)", "measured (mm)");
  for (const Failure& failure : failures()) {
    Bench bench(failure.more);
    std::vector<std::string> check = bench.arguments();
    check.emplace_back("--check");
    const Result table = run(check);
    ASSERT_EQ(table.exit_code, 0) << table.err;
    const Stated row = stated(table.out, failure.row);
    ASSERT_FALSE(std::isnan(row.time_s)) << failure.row << "\n" << table.out;
    Daemon daemon(bench.arguments(failure.row == "bus lost"));
    ASSERT_TRUE(bench.moves()) << failure.row << ": no motion";
    const std::int64_t begin_ns = hal::monotonic_ns();
    failure.cause(bench, daemon);
    const std::int64_t begun_ns = hal::monotonic_ns();
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    Measured measured = measure(bench.watcher().looks(), begin_ns, begun_ns, failure.at_command);
    if (failure.spoils_reading) measured.travel_m = 0.0;
    ASSERT_FALSE(std::isnan(measured.most_s)) << failure.row << ": never at null";
    char travel[32] = "-";
    if (!failure.spoils_reading) {
      std::snprintf(travel, sizeof travel, "%.2f", measured.travel_m * 1e3);
    }
    std::printf("# %-24s %-8s %14.1f %7.1f to %5.1f %20.2f %16s\n", failure.row.c_str(), "modbus",
                row.time_s * 1e3, measured.least_s * 1e3, measured.most_s * 1e3, row.travel_m * 1e3,
                travel);
    if (failure.row == "process stopped") {
      signal_daemon(daemon, SIGCONT);
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      EXPECT_LT(std::abs(bench.watcher().looks().back().valve_V), kNull_V)
          << "an old command came through, or the law went on by itself";
    }
    signal_daemon(daemon, SIGTERM);
    const Result result = daemon.wait();
    const bool prompt = result.err.find("SCHED_FIFO") != std::string::npos &&
                        result.err.find("no SCHED_FIFO") == std::string::npos;
    if (failure.device_decides || prompt) {
      EXPECT_LE(measured.least_s, row.time_s) << failure.row;
      EXPECT_LE(measured.travel_m, row.travel_m) << failure.row;
    }
  }
}

TEST(Permit, LetsARelayTakeTheCommandAwayWhenTheDaemonTripsOrDies) {
  for (const bool killed : {true, false}) {
    Bench bench(std::string(kGuards) + kPermit);
    Daemon daemon(bench.arguments());
    ASSERT_TRUE(bench.moves());
    // From now on the relay is all there is: no time-out of the command.
    bench.set("permit_timeout_s=0.05");
    bench.set("command_timeout_s=0");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_TRUE(bench.moves()) << "the permit does not come";
    if (killed) signal_daemon(daemon, SIGKILL);
    if (!killed) bench.set("encoder_offset_m=0.02");  // guard jump: LATCHED
    EXPECT_TRUE(bench.watcher().wait_for(
        [](const Look& look) { return std::abs(look.valve_V) < kNull_V; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_LT(std::abs(bench.watcher().looks().back().valve_V), kNull_V);
    EXPECT_NE(bench.status() & hal::rig::kPermitMissing, 0);
  }
}

}  // namespace
}  // namespace program
