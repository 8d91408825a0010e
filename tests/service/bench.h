// The service on the bench: the rig as a process beside the container, a watcher on its registers,
// and the package's own configuration and orders inside.
#pragma once

#include <gmock/gmock.h>
#include <pthread.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "hal/hil_rig/server.h"
#include "tests/daemon/program/bench_watch.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/hal/hil_rig/rig_process.h"
#include "tests/service/machine.h"

namespace service {

using program::Look;

/// Voltages that still count as null: two steps of the converter.
inline constexpr double kNull_V = 0.01;
/// A command that is far from null.
inline constexpr double kFar_V = 1.5;
inline constexpr const char* kLcm = "udpm://239.255.76.69:7769?ttl=0";
inline constexpr const char* kConfiguration = "/etc/spoolwatch/spoolwatchd.toml";

inline bool at_null(const Look& look) { return std::abs(look.valve_V) < kNull_V; }

inline std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

/// bench_rig.toml without its faults.
class RigFile {
 public:
  RigFile() {
    std::string text = text_of(program::shipped("bench_rig.toml"));
    const std::size_t from = text.find("[[sim.fault]]");
    text.erase(from, text.find("[field]") - from);
    replace(text, "models/", program::shipped("models/"));
    std::ofstream(path()) << text;
  }
  [[nodiscard]] std::string path() const { return (folder_.path() / "rig.toml").string(); }

 private:
  program::Folder folder_;
};

class Service {
 public:
  /// The watcher looks as promptly as the rig answers, whatever else this machine does.
  Service() : rig_({"--config", file_.path()}) {
    const sched_param prompt{65};
    const sched_param normal{0};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &prompt);
    watcher_ = std::make_unique<program::Watcher>(rig_.port());
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &normal);
  }

  /// The shipped bench configuration, on this rig, as a service has it: not armed by itself.
  [[nodiscard]] std::string configuration() const {
    std::string text = machine_.run("cat /usr/share/spoolwatch/bench_modbus.toml").text;
    replace(text, "127.0.0.1:1502", rig_.address());
    replace(text, "auto_arm = true", "auto_arm = false");
    return text + "[control]\nsocket = \"/run/spoolwatch/control.sock\"\ngroup = \"spoolwatch\"\n" +
           "[recorder]\nfolder = \"/var/lib/spoolwatch\"\n[lcm]\nurl = \"" + kLcm + "\"\n";
  }
  void configure(const std::string& more = "") const {
    machine_.write(kConfiguration, configuration() + more);
  }
  /// `spoolwatch WORDS` by a member of the daemon's group.
  [[nodiscard]] Output order(const std::string& words, const char* user = "operator1") const {
    return machine_.run(std::string("runuser -u ") + user + " -- spoolwatch " + words);
  }
  /// Armed and started, and the valve far from null.
  void runs() {
    ASSERT_EQ(machine_.property("ActiveState"), "active");
    ASSERT_EQ(order("arm").text, "ARMED\n");
    ASSERT_EQ(order("start").text, "RUN\n");
    far_from_null();
  }
  void far_from_null() {
    ASSERT_TRUE(watcher_->wait_for([](const Look& look) { return look.valve_V > kFar_V; }));
  }
  /// Starts the service: it comes back from that when it is ready.
  void starts() {
    const Output started = machine_.run("systemctl start spoolwatchd");
    ASSERT_EQ(started.exit_code, 0) << started.text << journal();
    stays_at_null_since(hal::monotonic_ns() - 1);
    EXPECT_THAT(order("status").text, testing::HasSubstr(": DISARMED"));
  }
  [[nodiscard]] std::string journal() const {
    return machine_.run("journalctl -u spoolwatchd --no-pager | tail -40").text;
  }
  /// Waits, 20 s at most, until the journal holds these words.
  [[nodiscard]] bool writes(const std::string& words) const {
    for (int i = 0; i < 100; ++i) {
      if (journal().find(words) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return false;
  }
  /// The worst time that `--check` states, in s.
  [[nodiscard]] double stated_s(const std::string& failure) const {
    std::istringstream lines(
        machine_.run(std::string("spoolwatchd --check --config ") + kConfiguration).text);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("# " + failure + " ", 0) != 0) continue;
      std::istringstream rest(line.substr(2 + failure.size()));
      std::string backend;
      double time_ms = std::nan("");
      rest >> backend >> time_ms;
      return time_ms * 1e-3;
    }
    return std::nan("");
  }
  /// After that moment the valve was not at null for so long, in s: between the last look that saw
  /// it elsewhere and the first that saw it at null.
  struct Null {
    double least_s = 0.0;
    double most_s = std::nan("");
  };
  [[nodiscard]] Null null_after(std::int64_t from_ns) {
    watcher_->wait_for(at_null);
    Null null;
    for (const Look& look : watcher_->looks()) {
      if (look.after_ns < from_ns) continue;
      if (at_null(look)) {
        null.most_s = static_cast<double>(look.after_ns - from_ns) * 1e-9;
        break;
      }
      null.least_s = std::max(0.0, static_cast<double>(look.before_ns - from_ns) * 1e-9);
    }
    return null;
  }
  void stays_at_null_since(std::int64_t from_ns) {
    bool was_null = false;
    for (const Look& look : watcher_->looks()) {
      if (look.before_ns < from_ns) continue;
      was_null = was_null || at_null(look);
      ASSERT_TRUE(!was_null || at_null(look)) << look.valve_V << " V, and nobody has armed it";
    }
  }
  /// Holds the way to null against what is stated; prints it.
  void expect_null(const char* what, std::int64_t from_ns, double stated_s) {
    const Null measured = null_after(from_ns);
    std::printf("# %-46s stated %7.1f ms, measured %6.1f to %6.1f ms\n", what, stated_s * 1e3,
                measured.least_s * 1e3, measured.most_s * 1e3);
    EXPECT_FALSE(std::isnan(measured.most_s)) << what << ": never at null";
    EXPECT_LE(measured.least_s, stated_s) << what;
    stays_at_null_since(from_ns);
  }

  RigFile file_;
  hal::hil_rig::RigProcess rig_;
  std::unique_ptr<program::Watcher> watcher_;
  Machine machine_;
};

}  // namespace service
