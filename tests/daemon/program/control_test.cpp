// The running daemon ordered from the command line: states, refusals, e-stop, two daemons, a dead
// one's socket.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using testing::HasSubstr;

/// The shipped service on the simulated rig, with a socket of its own.
class Service {
 public:
  explicit Service(const std::vector<std::string>& settings = {}, bool settled = true)
      : daemon_(arguments(settings)) {
    if (settled) settle();
  }
  Result order(const std::string& words) const {
    return spoolwatch(words + " --socket " + socket());
  }
  /// Waits, ten seconds at most, until the daemon says so.
  bool becomes(const std::string& state) const {
    for (int i = 0; i < 200; ++i) {
      if (order("status").out.find(": " + state) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  Result end() {
    kill(daemon_.pid(), SIGTERM);
    return daemon_.wait();
  }
  [[nodiscard]] Daemon& daemon() { return daemon_; }
  [[nodiscard]] std::string socket() const { return (folder_.path() / "s").string(); }
  [[nodiscard]] Log log() const { return read_log(folder_.path() / "log"); }
  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& settings) const {
    std::vector<std::string> all = {
        "--config",  shipped("spoolwatchd.toml"),
        "--lcm-url", "",
        "--set",     "alarms.folder=",
        "--set",     "evidence.folder=",
        "--set",     "recorder.folder=" + (folder_.path() / "log").string(),
        "--set",     "control.socket=" + socket()};
    for (const std::string& setting : settings) {
      all.emplace_back("--set");
      all.push_back(setting);
    }
    return all;
  }

 private:
  void settle() const {
    for (int i = 0; i < 400; ++i) {
      if (order("status").exit_code == 0) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    ADD_FAILURE() << "the daemon does not answer";
  }

  Folder folder_;
  Daemon daemon_;
};

void expect_refused(const Result& result, const std::string& why) {
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1) << result.out;
  EXPECT_THAT(result.out, HasSubstr("spoolwatch: refused: " + why));
}

TEST(Control, ArmsStartsStopsAndSaysTheStateAfterEach) {
  Service service;
  EXPECT_THAT(service.order("status").out, HasSubstr("stand-1: DISARMED"));
  expect_refused(service.order("start"), "not possible in state DISARMED: arm first");
  EXPECT_EQ(service.order("arm").out, "ARMED\n");
  EXPECT_EQ(service.order("start").out, "RUN\n");
  EXPECT_EQ(service.order("reference --centre 0.3 --amplitude 0.005 --frequency 1").out, "RUN\n");
  EXPECT_EQ(service.order("hold").out, "RUN\n");
  EXPECT_THAT(service.order("status").out, HasSubstr("RUN, holding"));
  EXPECT_EQ(service.order("stop").out, "ARMED\n");
  EXPECT_EQ(service.order("disarm").out, "DISARMED\n");
  const std::string json = service.socket() + ".json";
  EXPECT_EQ(service.order("status --json " + json).exit_code, 0);
  std::ifstream in(json);
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(in), {}),
              HasSubstr("\"state\": \"DISARMED\""));
  EXPECT_EQ(service.end().exit_code, 0);
  // Every start is where the rod is: no sample's reference jumps away from it.
  std::int8_t before = 1;
  int starts = 0;
  for (const auto& s : service.log().samples) {
    if (s.state == 3 && before != 3) {
      EXPECT_EQ(s.reference_m, s.y_m);
      ++starts;
    }
    before = s.state;
  }
  EXPECT_EQ(starts, 1);
}

TEST(Control, AFloodOfRequestsNeitherStopsTheLoopNorKeepsASignalFromIt) {
  Service service;
  std::vector<FILE*> floods;
  for (int i = 0; i < 4; ++i) {
    const std::string flood = "while " SPOOLWATCH_BIN_DIR "/spoolwatch status --socket " +
                              service.socket() + "; do :; done > /dev/null 2>&1";
    floods.push_back(popen(flood.c_str(), "r"));
  }
  EXPECT_EQ(service.order("arm").out, "ARMED\n");
  EXPECT_EQ(service.order("start").out, "RUN\n");
  EXPECT_EQ(service.end().exit_code, 0);
  for (FILE* flood : floods) pclose(flood);  // it ends with the daemon
  EXPECT_EQ(service.log().samples.back().state, 1);
}

TEST(Control, WithoutADaemonIsOneLineAndExitCode1) {
  for (const char* word : {"status", "arm", "disarm", "start", "stop", "reset"}) {
    const Result result = spoolwatch(std::string(word) + " --socket /tmp/no/such/socket");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "spoolwatch: control socket /tmp/no/such/socket: no daemon is there\n");
  }
}

TEST(Control, AnEmergencyStopLatchesAndForbidsToArmUntilItIsReleased) {
  Service service({"sim.input.0.from_s=3.0", "sim.input.0.to_s=6.0"});
  EXPECT_EQ(service.order("arm").exit_code, 0);
  EXPECT_EQ(service.order("start").out, "RUN\n");
  EXPECT_TRUE(service.becomes("LATCHED by e_stop"));
  expect_refused(service.order("arm"), "not possible in state LATCHED: reset first");
  EXPECT_EQ(service.order("reset").out, "DISARMED\n");
  expect_refused(service.order("arm"), "guard e_stop: the emergency stop is not released");
  EXPECT_THAT(service.order("status").out, HasSubstr("cannot be armed: input e_stop"));
  for (int i = 0; i < 200 && service.order("arm").exit_code != 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_THAT(service.order("status").out, HasSubstr("stand-1: ARMED"));
  EXPECT_EQ(service.end().exit_code, 0);
  const Log log = service.log();
  // From the first sample without release on, null.
  for (const auto& s : log.samples) {
    if (s.tick < 600 || s.tick >= 1200) continue;
    ASSERT_EQ(s.u_applied_V, 0.0) << s.tick;
  }
  EXPECT_EQ(log.timeline("e_stop", 0.005).substr(0, 4), "3.0 ") << log.timeline("e_stop", 0.005);
}

TEST(Control, AnEmergencyStopWiredTheWrongWayIsNeverArmed) {
  for (const char* wiring : {"sim.input.0.value=0.0", "sim.input.0.from_s=0.0"}) {
    Service service({wiring, "sim.input.0.missing=true"});
    expect_refused(service.order("arm"), "guard e_stop");
    EXPECT_THAT(service.order("status").out, HasSubstr("stand-1: DISARMED"));
  }
}

TEST(Control, WhatMovesIsNotArmedWithoutACalibrationOfThisRig) {
  const std::vector<std::string> real = {"sim.pretend_real=true"};
  {
    Service service(real);
    expect_refused(service.order("arm"), "no [rig] calibration in ");
  }
  const Folder folder;
  const std::string file = (folder.path() / "calibration.toml").string();
  const std::vector<std::string> named = {"sim.pretend_real=true", "rig.calibration=" + file};
  {
    Service service(named);
    expect_refused(service.order("arm"), "no calibration " + file);
  }
  const auto write = [&](const char* rig) {
    std::ofstream(file) << "schema_version = 1\nrig_id = \"" << rig
                        << "\"\ndate = \"2026-03-01\"\nlatency_s = 0.004\n[valve]\nsign = 1\n"
                           "null_V = 0.0\ndead_zone_V = 0.0\n[rod]\nsign = 1\nscale = 1.0\n"
                           "noise_m = 2e-6\n";
  };
  write("another");
  Service refused(named, false);
  const Result result = refused.daemon().wait();
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(result.err, HasSubstr("rig_id: is \"another\"; allowed: \"stand-1\""));
  write("stand-1");
  Service service(named);
  EXPECT_EQ(service.order("arm").out, "ARMED\n");
}

TEST(Control, TwoDaemonsCannotShareASocketAndADeadOnesIsReplaced) {
  Service service;
  const Result second = run(service.arguments({}));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.err, HasSubstr("another daemon serves it"));
  kill(service.daemon().pid(), SIGKILL);
  EXPECT_EQ(service.daemon().wait().exit_code, -SIGKILL);
  EXPECT_TRUE(std::filesystem::exists(service.socket()));
  EXPECT_EQ(service.order("status").exit_code, 1);
  Daemon third(service.arguments({}));
  EXPECT_TRUE(service.becomes("DISARMED"));
  kill(third.pid(), SIGTERM);
  EXPECT_EQ(third.wait().exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(service.socket()));
}

}  // namespace
}  // namespace program
