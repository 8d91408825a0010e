// Every failure on the bench rig over Modbus, measured at the rig itself by a client of its own:
// how long the valve keeps a command, how far the rod travels. Held against what `--check` states.
#include <gmock/gmock.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <sys/socket.h>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <mutex>
#include <sstream>
#include <thread>

#include "hal/device_thread.h"
#include "hal/rig/register_map.h"
#include "hal/rig/server.h"
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

/// What was seen at the rig: between the two times.
struct Look {
  std::int64_t before_ns, after_ns;
  double command_V, valve_V, rod_m;
};

double real(const std::uint16_t* words) {
  return static_cast<double>(modbus_get_float_abcd(words));
}

/// Looks at the rig as often as it answers, on a connection of its own.
class Watcher {
 public:
  explicit Watcher(int port) : bus_(modbus_new_tcp("127.0.0.1", port)) {
    EXPECT_EQ(modbus_connect(bus_), 0);
    thread_ = std::thread([this] { watch(); });
  }
  ~Watcher() {
    ended_ = true;
    thread_.join();
    modbus_close(bus_);
    modbus_free(bus_);
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  std::vector<Look> looks() {
    const std::lock_guard lock(mutex_);
    return looks_;
  }
  /// Waits, ten seconds at most, until a look fulfils it.
  bool wait_for(const std::function<bool(const Look&)>& wanted) {
    for (int i = 0; i < 10000; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (!looks_.empty() && wanted(looks_.back())) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

 private:
  void watch() {
    std::uint16_t words[8];
    while (!ended_) {
      Look look{};
      look.before_ns = hal::monotonic_ns();
      if (modbus_read_registers(bus_, hal::rig::kCommand, 8, words) != 8) continue;
      look.after_ns = hal::monotonic_ns();
      look.command_V = real(words);
      look.rod_m = real(words + hal::rig::kPosition - hal::rig::kCommand);
      look.valve_V = real(words + hal::rig::kValve - hal::rig::kCommand);
      {
        const std::lock_guard lock(mutex_);
        looks_.push_back(look);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  }

  modbus_t* bus_;
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::vector<Look> looks_;
  std::thread thread_;
};

/// A cable between daemon and rig that can be cut: what is sent afterwards is lost.
class Cable {
 public:
  explicit Cable(int rig_port) : rig_port_(rig_port), listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = loopback(0);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 8), 0);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { carry(); });
  }
  ~Cable() {
    ended_ = true;
    thread_.join();
    close(listener_);
    for (const auto& [one, other] : pairs_) {
      close(one);
      close(other);
    }
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;
  void cut() { cut_ = true; }
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  static sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    return address;
  }
  void carry() {
    const sched_param prompt{70};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &prompt);  // else the normal class
    while (!ended_) {
      std::vector<pollfd> files{{listener_, POLLIN, 0}};
      for (const auto& [one, other] : pairs_) {
        files.push_back({one, POLLIN, 0});
        files.push_back({other, POLLIN, 0});
      }
      if (poll(files.data(), files.size(), 20) <= 0) continue;
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        if (files[2 * i + 1].revents != 0) pass(pairs_[i].first, pairs_[i].second);
        if (files[2 * i + 2].revents != 0) pass(pairs_[i].second, pairs_[i].first);
      }
      if (files[0].revents == 0) continue;
      const int client = accept(listener_, nullptr, nullptr);
      const int rig = socket(AF_INET, SOCK_STREAM, 0);
      const int at_once = 1;
      for (const int file : {client, rig}) {
        setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
      }
      const sockaddr_in address = loopback(rig_port_);
      (void)connect(rig, reinterpret_cast<const sockaddr*>(&address), sizeof address);
      pairs_.emplace_back(client, rig);
    }
  }
  void pass(int from, int to) const {
    char bytes[512];
    const ssize_t n = recv(from, bytes, sizeof bytes, 0);
    if (n > 0 && !cut_) (void)send(to, bytes, static_cast<std::size_t>(n), MSG_NOSIGNAL);
    if (n <= 0) {
      shutdown(to, SHUT_RDWR);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  int rig_port_;
  int listener_;
  int port_ = 0;
  std::atomic<bool> cut_{false};
  std::atomic<bool> ended_{false};
  std::vector<std::pair<int, int>> pairs_;
  std::thread thread_;
};

/// bench_modbus.toml with guards, and the shipped daemon on it.
class Bench {
 public:
  Bench()
      : rig_({"--config", hal::rig::shipped_config("bench_rig.toml")}),
        cable_(rig_.port()),
        watcher_(rig_.port()) {
    std::ifstream in(shipped("bench_modbus.toml"));
    std::ofstream(file()) << in.rdbuf() << kGuards;
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
  };
}

TEST(NullMatrix, OnTheBenchRigOverModbusIsNeverWorseThanStated) {
  std::printf("# %-24s %-8s %14s %16s %20s %16s\n", "failure", "valve", "stated (ms)",
              "measured (ms)", "stated travel (mm)", "measured (mm)");
  for (const Failure& failure : failures()) {
    Bench bench;
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
    if (failure.spoils_reading) measured.travel_m = std::nan("");
    ASSERT_FALSE(std::isnan(measured.most_s)) << failure.row << ": never at null";
    std::printf("# %-24s %-8s %14.1f %7.1f to %5.1f %20.2f %16.2f\n", failure.row.c_str(), "modbus",
                row.time_s * 1e3, measured.least_s * 1e3, measured.most_s * 1e3, row.travel_m * 1e3,
                measured.travel_m * 1e3);
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
      EXPECT_FALSE(measured.travel_m > row.travel_m) << failure.row;
    }
  }
}

}  // namespace
}  // namespace program
