// A better model into the running daemon and back again, and what is refused.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/daemon/program/subprocess.h"
#include "tests/workbench/live/healthy_log.h"

namespace workbench::promotion {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The daemon's configuration; without bands it also makes the records.
std::string rig(const std::string& more) {
  std::string text = read(program::shipped("thesis_case1.toml"));
  text = text.substr(0, text.find("[[band]]"));
  const std::string from = "encoder_resolution_m = 0.0\nnoise_m = 0.0\ndac_bits = 0\n";
  text.replace(text.find(from), from.size(),
               "encoder_resolution_m = 5e-6\nnoise_m = 2e-6\ndac_bits = 12\n");
  return more + text;
}
/// The same without the faults of the shipped one.
std::string without_faults(std::string text) {
  const std::size_t begin = text.find("[[sim.fault]]");
  return text.erase(begin, text.find("[reference]") - begin);
}

class Promote : public testing::Test {
 protected:
  /// `first`: there are no bands yet.
  explicit Promote(bool first = false) {
    const std::string model = program::shipped("models/thesis_calibrated.toml");
    std::ofstream(path("healthy.toml")) << without_faults(rig(""));
    std::ofstream(path("faulty.toml")) << rig("");
    const auto log = [&](const char* config, const char* folder) {
      std::vector<std::string> arguments =
          program::virtual_run(path(config), path(folder), {"--set", "sim.model=" + model});
      arguments.insert(arguments.end(), {"--duration", "60"});
      const program::Result result = program::run(arguments);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return fs::directory_iterator(path(folder))->path().string();
    };
    healthy_ = log("healthy.toml", "healthy");
    faulty_ = log("faulty.toml", "faulty");
    right_ = read(model);
    wrong_ = right_;
    // Wrong by more than the faults of the faulty record.
    const std::string supply = "supply_pressure_Pa = ";
    const std::size_t at = wrong_.find(supply);
    EXPECT_NE(at, std::string::npos);
    wrong_.replace(at, wrong_.find('\n', at) - at, supply + "3e6");
    std::ofstream(path("model.toml")) << wrong_;
    std::ofstream(path("right.toml")) << right_;
    std::ofstream(path("wrong.toml")) << wrong_;
    std::ofstream(path("rig.toml")) << without_faults(rig("bands_file = \"bands.toml\"\n")) << R"(
[[band]]
id = "gain"
quantity = "sliding.b1"
[model]
file = "model.toml"
[control]
socket = "s"
[alarms]
folder = "alarms"
)";
    // Learned, then made so wide that nothing is ever out.
    const program::Result learned = program::spoolwatch("calibrate " + path("rig.toml") + ' ' +
                                                        healthy_ + " -o " + path("bands.toml"));
    EXPECT_EQ(learned.exit_code, 0) << learned.out;
    std::string bands = read(path("bands.toml"));
    for (const auto& [key, value] :
         {std::pair("\nlow = ", "-1.0"), std::pair("\nhigh = ", "1.0")}) {
      const std::size_t place = bands.find(key) + std::string(key).size();
      bands.replace(place, bands.find('\n', place) - place, value);
    }
    std::ofstream(path("bands.toml")) << bands;
    wide_ = bands;
    if (first) fs::remove(path("bands.toml"));
    daemon_ = std::make_unique<program::Daemon>(
        std::vector<std::string>{"--config", path("rig.toml"), "--lcm-url", "", "--set",
                                 "sim.model=" + model, "--set", "loop.privileges=off"});
    for (int i = 0; i < 100 && !fs::exists(path("s")); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  ~Promote() override {
    kill(daemon_->pid(), SIGTERM);
    (void)daemon_->wait();
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] program::Result promote(const std::string& words) const {
    return program::spoolwatch("promote " + words + " --socket " + path("s"));
  }
  [[nodiscard]] json status() const {
    return json::parse(program::spoolwatch("status --json - --socket " + path("s")).out, nullptr,
                       false);
  }

  program::Folder folder_;
  std::string healthy_, faulty_, right_, wrong_, wide_;
  std::unique_ptr<program::Daemon> daemon_;
};

TEST_F(Promote, TakesABetterModelAndGivesTheOldOneBack) {
  const json before = status();
  const program::Result result = promote(path("right.toml") + " --record " + healthy_);
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("in use; the one before it is kept as version 1"));
  EXPECT_EQ(read(path("model.toml")), right_);
  EXPECT_NE(read(path("bands.toml")), wide_);
  const json promoted = status();
  EXPECT_NE(promoted["rules_hash"], before["rules_hash"]);

  const program::Result worse = promote(path("wrong.toml") + " --record " + healthy_);
  EXPECT_EQ(worse.exit_code, 1);
  EXPECT_THAT(worse.out, HasSubstr("refused: the new model is worse: error "));
  EXPECT_EQ(read(path("model.toml")), right_);
  EXPECT_EQ(status()["rules_hash"], promoted["rules_hash"]);

  const program::Result back = promote("--back");
  EXPECT_EQ(back.exit_code, 0) << back.out;
  EXPECT_EQ(read(path("model.toml")), wrong_);
  EXPECT_EQ(read(path("bands.toml")), wide_);
  EXPECT_EQ(status()["rules_hash"], before["rules_hash"]);
  EXPECT_THAT(promote("--back").out, HasSubstr("there is none before"));

  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the clerk's
  const std::string audit = read(path("alarms/audit.log"));
  for (const char* part :
       {"tried on", "compared: error", "bands learned: sliding.b1", "back-tested: no new alarm",
        "reload", "in use; ", "refused: the new model is worse", "version 1 is in use again"}) {
    EXPECT_THAT(audit, HasSubstr(part));
  }
}

TEST_F(Promote, KeepsWhatIsInUseWhereTheDaemonDoesNotTakeTheVersionBefore) {
  ASSERT_EQ(promote(path("right.toml") + " --record " + healthy_).exit_code, 0);
  const json promoted = status();
  const std::string bands = read(path("bands.toml"));
  std::ofstream(path("bands.toml.v1")) << "no bands";
  const program::Result back = promote("--back");
  EXPECT_EQ(back.exit_code, 1);
  EXPECT_THAT(back.out, HasSubstr("the daemon did not take it, the files in use are back: "));
  EXPECT_EQ(read(path("model.toml")), right_);
  EXPECT_EQ(read(path("bands.toml")), bands);
  EXPECT_TRUE(fs::exists(path("model.toml.v1"))) << "the version is not used up";
  EXPECT_EQ(status()["rules_hash"], promoted["rules_hash"]);
}

TEST_F(Promote, IsRefusedWhenTheBandsWouldTellNewAlarms) {
  const program::Result result =
      promote(path("right.toml") + " --record " + healthy_ + " --record " + faulty_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("new alarms on the healthy records: sliding.gain at "));
  EXPECT_EQ(read(path("model.toml")), wrong_);
  EXPECT_EQ(read(path("bands.toml")), wide_);
  EXPECT_FALSE(fs::exists(path("bands.toml.new")));
  EXPECT_FALSE(fs::exists(path("bands.toml.v1")));
}

class FirstPromotion : public Promote {
 protected:
  FirstPromotion() : Promote(true) {}
};

// A busy machine loses periods: estimates across them are INVALID by whatever bands.
TEST_F(FirstPromotion, IsNotRefusedForPeriodsThatTheRecordHasLost) {
  const std::string whole = path("whole.csv");
  const program::Result exported = program::spoolwatch("export " + healthy_ + " -o " + whole);
  ASSERT_EQ(exported.exit_code, 0) << exported.out;
  std::ifstream in(whole);
  std::ofstream out(path("lossy.csv"));
  std::string line;
  for (int i = 0; std::getline(in, line); ++i) {
    if (i % 700 > 3 || i < 700) out << line << '\n';
  }
  out.close();
  const program::Result result =
      promote(path("right.toml") + " --record " + healthy_ + " --record " + path("lossy.csv"));
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("back-tested: no new alarm on 2 records"));
}

TEST_F(Promote, IsRefusedWhenTheDaemonRunsByOtherRules) {
  std::ofstream(path("bands.toml"), std::ios::app) << "\n# touched\n";
  EXPECT_EQ(promote(path("right.toml") + " --record " + healthy_).exit_code, 0)
      << "a comment changes no rule";
  std::string rig_text = read(path("rig.toml"));
  rig_text.replace(rig_text.find("warmup_s = 2.0"), 14, "warmup_s = 3.0");
  std::ofstream(path("rig.toml")) << rig_text;
  const program::Result other = promote("--back");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.out, HasSubstr("the daemon runs by other rules than "));
}

}  // namespace
}  // namespace workbench::promotion
