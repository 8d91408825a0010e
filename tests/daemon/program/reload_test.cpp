// The configuration read again while the daemon runs: by a signal and from the command line,
// without a lost cycle or a lost alarm; what is wrong or may not change leaves everything as it
// was.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/daemon/program/json_lines.h"
#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Reload : public testing::Test {
 protected:
  Reload() { write(0.2, ""); }
  ~Reload() override { end(); }

  void write(double high_m, const std::string& more) const {
    std::ifstream shipped_file(shipped("thesis_case1.toml"));
    const std::string text(std::istreambuf_iterator<char>(shipped_file), {});
    std::ofstream(file()) << more << text << "\n[[band]]\nid = \"standing\"\n"
                          << "quantity = \"sample.y_m\"\nlatch = true\nhigh = " << high_m << R"(
[control]
socket = "s"
[alarms]
folder = "alarms"
[evidence]
folder = "evidence"
before_s = 1.0
after_s = 0.5
)";
  }
  /// With a travel guard, around a motion from 0.28 to 0.33 m.
  void write_with_guard(double high_m) const {
    write(0.2, "");
    std::ofstream(file(), std::ios::app)
        << "\n[[guard]]\nkind = \"travel\"\nhigh_m = " << high_m << "\n";
  }
  [[nodiscard]] std::string file() const { return (folder_.path() / "rig.toml").string(); }
  void start() {
    daemon_ = std::make_unique<Daemon>(std::vector<std::string>{
        "--config", file(), "--lcm-url", "", "--set",
        "sim.model=" + shipped("models/thesis_calibrated.toml"), "--set", "loop.privileges=off",
        "--set", "recorder.folder=" + (folder_.path() / "log").string()});
    ASSERT_TRUE(becomes([&] { return order("alarms").out.find("sample.standing") != kNone; }));
  }
  Result end() {
    if (daemon_ == nullptr) return {};
    kill(daemon_->pid(), SIGTERM);
    Result result = daemon_->wait();
    daemon_.reset();
    return result;
  }
  [[nodiscard]] Result order(const std::string& words) const {
    return spoolwatch(words + " --socket " + (folder_.path() / "s").string());
  }
  [[nodiscard]] json ask(const std::string& word) const {
    return json::parse(order(word + " --json -").out, nullptr, false);
  }
  [[nodiscard]] json alarm_named(const std::string& name) const {
    const json answer = ask("alarms");
    for (const json& alarm : answer["alarms"]) {
      if (alarm["name"] == name) return alarm;
    }
    return {};
  }
  [[nodiscard]] json standing() const { return alarm_named("standing"); }
  template <class F>
  static bool becomes(F&& f) {
    for (int i = 0; i < 100; ++i) {
      if (f()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  [[nodiscard]] std::vector<json> audit() const {
    return json_lines(folder_.path() / "alarms" / "audit.log");
  }

  static constexpr auto kNone = std::string::npos;
  Folder folder_;
  std::unique_ptr<Daemon> daemon_;
};

TEST_F(Reload, TakesNewLimitsWithoutALostCycleOrAlarm) {
  start();
  const json before = ask("status");
  ASSERT_EQ(standing()["high"], 0.2);
  write(0.25, "");
  kill(daemon_->pid(), SIGHUP);
  ASSERT_TRUE(becomes([&] { return standing()["high"] == 0.25; }));
  EXPECT_EQ(standing()["life"], "UNACKNOWLEDGED");
  EXPECT_EQ(standing()["times"], 1);
  EXPECT_NE(ask("status")["config_hash"], before["config_hash"]);

  write(0.5, "");  // the rod is inside now: the latched alarm stays
  const Result second = order("reload");
  EXPECT_EQ(second.exit_code, 0) << second.out;
  EXPECT_THAT(second.out, HasSubstr("changed: [[band]] standing: high\n"));
  EXPECT_THAT(second.out, HasSubstr("estimator continues: "));
  EXPECT_EQ(standing()["high"], 0.5);
  EXPECT_TRUE(becomes([&] { return standing()["life"] == "LATCHED"; })) << standing().dump();
  EXPECT_THAT(order("reload").out, HasSubstr("no key has changed"));
  EXPECT_EQ(order("ack standing").exit_code, 0);
  EXPECT_EQ(standing()["life"], "NORMAL");

  EXPECT_TRUE(becomes([&] { return ask("status")["ticks"].get<int>() > 300; }));
  const Result result = end();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("new rules, configuration "));
  const Log log = read_log(folder_.path() / "log");
  ASSERT_GT(log.samples.size(), 100U);
  for (std::size_t i = 1; i < log.samples.size(); ++i) {
    ASSERT_EQ(log.samples[i].seq, log.samples[i - 1].seq + 1);
    ASSERT_EQ(log.samples[i].tick, log.samples[i - 1].tick + 1 + log.samples[i].gap);
  }
  const std::vector<json> acts = audit();
  ASSERT_GE(acts.size(), 3U);
  EXPECT_EQ(acts[0]["what"], "SIGHUP");
  EXPECT_EQ(acts[0]["done"], true);
  EXPECT_EQ(acts[1]["uid"], ::getuid());
}

TEST_F(Reload, TightensGuardsInRunAndLoosensThemOnlyWhileNothingIsArmed) {
  const auto state = [&] { return ask("status")["state"]; };
  write_with_guard(0.40);
  start();
  ASSERT_TRUE(becomes([&] { return state() == "RUN"; }));
  write_with_guard(0.35);
  const Result tighter = order("reload");
  EXPECT_EQ(tighter.exit_code, 0);
  EXPECT_THAT(tighter.out, HasSubstr("changed: [[guard]] travel: high_m\n"));
  const json before = ask("status");
  EXPECT_EQ(before["state"], "RUN");

  write_with_guard(0.45);
  const Result looser = order("reload");
  EXPECT_EQ(looser.exit_code, 1);
  EXPECT_THAT(
      looser.out,
      HasSubstr("rig.toml: [[guard]] travel: high_m: lets more pass, which is refused while "
                "the rig is ARMED or in RUN; allowed: tighter limits; others after "
                "spoolwatch disarm"));
  EXPECT_EQ(ask("status")["config_hash"], before["config_hash"]);
  EXPECT_EQ(order("disarm").exit_code, 0);
  EXPECT_EQ(order("reload").exit_code, 0);
  EXPECT_NE(ask("status")["config_hash"], before["config_hash"]);

  EXPECT_EQ(order("arm").exit_code, 0);
  EXPECT_EQ(order("start").exit_code, 0);
  write_with_guard(0.31);  // inside the motion
  EXPECT_EQ(order("reload").exit_code, 0);
  EXPECT_TRUE(becomes([&] { return state() == "LATCHED"; }));
  EXPECT_EQ(ask("status")["latched_by"], "travel");
  EXPECT_EQ(alarm_named("travel")["high"], 0.31);
}

TEST_F(Reload, OfABadFileKeepsTheOldOneAndSaysWhy) {
  start();
  const json before = ask("status");
  write(0.25, "nonsense = ");
  const Result bad = order("reload");
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("rig.toml"));
  EXPECT_EQ(standing()["high"], 0.2);
  EXPECT_EQ(ask("status")["config_hash"], before["config_hash"]);
  EXPECT_THAT(order("status").out, HasSubstr("the old configuration remains active: "));

  write(-0.1, "bands_file = \"none.toml\"\n");
  EXPECT_THAT(order("reload").out, HasSubstr("none.toml"));
  write(0.3, "");
  std::ofstream(file(), std::ios::app) << "\n[safety]\nramp_s = 0.77\n";
  EXPECT_THAT(order("reload").out,
              HasSubstr("[safety] ramp_s: cannot change while the daemon runs"));
  write(0.3, "");
  std::ofstream(file(), std::ios::app) << "\n[[guard]]\nkind = \"travel\"\nhigh_m = 0.4\n";
  const Result guards = order("reload");
  EXPECT_EQ(guards.exit_code, 1);
  EXPECT_THAT(guards.out, HasSubstr("[[guard]] travel: "));
  EXPECT_THAT(guards.out, HasSubstr("cannot change while the daemon runs because it affects the "
                                    "valve: restart the daemon"));
  EXPECT_EQ(standing()["high"], 0.2) << "nothing of it is taken";

  write(0.3, "");
  EXPECT_EQ(order("reload").exit_code, 0);
  EXPECT_EQ(ask("status")["reload_refused"], nullptr);
  EXPECT_EQ(standing()["high"], 0.3);
  EXPECT_EQ(end().exit_code, 0);
  const std::vector<json> acts = audit();
  ASSERT_EQ(acts.size(), 5U);
  EXPECT_EQ(acts[0]["done"], false);
  EXPECT_THAT(acts[2]["reason"].get<std::string>(), HasSubstr("[safety] ramp_s"));
  EXPECT_EQ(acts[4]["done"], true);
}

}  // namespace
}  // namespace program
