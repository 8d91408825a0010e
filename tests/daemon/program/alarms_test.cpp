// Alarms of the running daemon: listed, acknowledged and shelved from the command line, by whom,
// and found again after a kill.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/daemon/program/json_lines.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Alarms : public testing::Test {
 protected:
  Alarms() {
    std::ifstream shipped_file(shipped("thesis_case1.toml"));
    const std::string text(std::istreambuf_iterator<char>(shipped_file), {});
    std::ofstream(file()) << text << R"(
[[band]]
id = "standing"
quantity = "sample.y_m"
high = 0.2
guidance = "nothing"
shelve_limit_s = 1000.0

[[band]]
id = "swings"
quantity = "sample.y_m"
high = 0.32
latch = true
chatter_count = 0

[control]
socket = "s"

[alarms]
folder = "alarms"

[evidence]
folder = "evidence"
before_s = 2.0
after_s = 1.0
)";
  }
  ~Alarms() override { end(); }

  [[nodiscard]] std::string file() const { return (folder_.path() / "rig.toml").string(); }
  void start() {
    daemon_ = std::make_unique<Daemon>(std::vector<std::string>{
        "--config", file(), "--lcm-url", "", "--set",
        "sim.model=" + shipped("models/thesis_calibrated.toml"), "--set", "loop.privileges=off"});
  }
  Result end(int signal = SIGTERM) {
    if (daemon_ == nullptr) return {};
    kill(daemon_->pid(), signal);
    Result result = daemon_->wait();
    daemon_.reset();
    return result;
  }
  Result order(const std::string& words) const {
    return spoolwatch(words + " --socket " + (folder_.path() / "s").string());
  }
  /// Twenty seconds at most.
  bool shows(const std::string& row) {
    for (int i = 0; i < 200; ++i) {
      if (order("alarms").out.find(row) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  /// The daemon counts once a second.
  bool status_shows(const std::string& text) {
    for (int i = 0; i < 100; ++i) {
      if (order("status").out.find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  [[nodiscard]] std::vector<json> audit() const {
    return json_lines(folder_.path() / "alarms" / "audit.log");
  }

  Folder folder_;
  std::unique_ptr<Daemon> daemon_;
};

TEST_F(Alarms, AreSeenActedOnAndFoundAgainAfterAKill) {
  start();
  ASSERT_TRUE(shows("UNACKNOWLEDGED  MAJOR    sample.standing"));
  EXPECT_THAT(order("alarms").out, HasSubstr("first up"));
  EXPECT_THAT(order("alarms").out, HasSubstr("    do: nothing\n"));
  EXPECT_TRUE(status_shows(" active: spoolwatch alarms\n"));
  EXPECT_EQ(order("ack sample.standing").out, "sample.standing\n");
  EXPECT_THAT(order("alarms").out, HasSubstr("ACKNOWLEDGED    MAJOR    sample.standing"));
  const Result again = order("ack standing");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.out, HasSubstr("refused: sample.standing: nothing to acknowledge"));
  EXPECT_THAT(order("ack nothing.there").out, HasSubstr("no alarm \"nothing.there\""));
  EXPECT_THAT(order("shelve standing --for 1h").out, HasSubstr("limited to 1000 s"));
  EXPECT_EQ(order("shelve standing --for soon").exit_code, 2);
  EXPECT_EQ(order("shelve standing --for 10min").out, "sample.standing\n");
  const json listed = json::parse(order("alarms --json -").out);
  for (const json& alarm : listed["alarms"]) {
    if (alarm["name"] != "standing") continue;
    EXPECT_EQ(alarm["life"], "SHELVED");
    EXPECT_EQ(alarm["active"], true);
    EXPECT_NEAR(alarm["shelved_for_s"].get<double>(), 600.0, 5.0);
  }
  ASSERT_TRUE(shows("LATCHED         MAJOR    sample.swings")) << order("alarms").out;

  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the writer's
  EXPECT_EQ(end(SIGKILL).exit_code, -SIGKILL);
  const std::vector<json> acts = audit();
  ASSERT_EQ(acts.size(), 5U);
  EXPECT_EQ(acts[0]["uid"], ::getuid());
  EXPECT_THAT(acts[0]["what"].get<std::string>(), HasSubstr("\"ack\""));
  EXPECT_EQ(acts[0]["done"], true);
  EXPECT_EQ(acts[1]["done"], false);
  EXPECT_THAT(acts[3]["reason"].get<std::string>(), HasSubstr("limited to 1000 s"));

  start();
  ASSERT_TRUE(shows("SHELVED         MAJOR    sample.standing"));
  EXPECT_THAT(order("alarms").out, HasSubstr("shelved for 10 min by "));
  EXPECT_TRUE(shows("sample.swings"));
  EXPECT_EQ(order("unshelve standing").out, "sample.standing\n");
  EXPECT_THAT(order("alarms").out, HasSubstr("ACKNOWLEDGED    MAJOR    sample.standing"))
      << "it was acknowledged before the kill";
  EXPECT_THAT(order("ack --all").out, Not(HasSubstr("standing")));
  EXPECT_EQ(end().exit_code, 0);
}

TEST_F(Alarms, OfADamagedFileBeginAnewWithOneLine) {
  fs::create_directory(folder_.path() / "alarms");
  std::ofstream(folder_.path() / "alarms" / "alarms.json") << "{\"format\": \"spoolw";
  start();
  EXPECT_TRUE(shows("UNACKNOWLEDGED  MAJOR    sample.standing"));
  const Result result = end();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("alarms.json: is not an alarm file or is damaged; all alarms "
                                    "start from their initial state"));
}

TEST_F(Alarms, ThatCannotBeSavedAreAnAlarmThemselves) {
  start();
  ASSERT_TRUE(shows("sample.standing"));
  fs::rename(folder_.path() / "alarms", folder_.path() / "elsewhere");
  std::ofstream(folder_.path() / "alarms") << "a file where the folder should be";
  EXPECT_EQ(order("ack standing").exit_code, 0) << "people can act all the same";
  EXPECT_TRUE(shows("MINOR    alarms.not_saved")) << order("alarms").out;
  EXPECT_TRUE(shows("MINOR    alarms.audit_lost")) << order("alarms").out;
  EXPECT_TRUE(shows("MINOR    alarms.history_not_saved")) << order("alarms").out;
  const Result result = end();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("history.log: "));
  EXPECT_THAT(result.err, HasSubstr(" lines could not be written"));
}

TEST_F(Alarms, HaveEvidenceThatLeadsToThemThoughPeopleActedMeanwhile) {
  start();
  ASSERT_TRUE(shows("sample.standing"));
  order("shelve standing --for 2s");
  ASSERT_TRUE(shows("LATCHED         MAJOR    sample.swings"));
  order("ack swings");
  order("ack --all");
  ASSERT_TRUE(shows("LATCHED         MAJOR    sample.swings")) << "two seconds later, again";
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(end().exit_code, 0);
  int packs = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "evidence")) {
    const Result result = spoolwatch("replay " + entry.path().string());
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_THAT(result.out, HasSubstr(", bit for bit\n"));
    ++packs;
  }
  EXPECT_GE(packs, 3);
}

}  // namespace
}  // namespace program
