// Reloads against a queue that the test serves in place of the detector.
#include "daemon/reloader.h"

#include <gmock/gmock.h>

#include <sstream>

#include "config/schema/error.h"
#include "tests/daemon/program/subprocess.h"

namespace monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kSampleTime_s = 0.005;

class ReloaderTest : public testing::Test {
 protected:
  ReloaderTest() {
    read(running_);
    reloader_ = std::make_unique<Reloader>(Reloader::Parts{clock_, log_, nullptr, false,
                                                           [this](DaemonConfig& config) {
                                                             read(config);
                                                             edit_(config);
                                                           },
                                                           0},
                                           running_, kSampleTime_s);
  }
  static void read(DaemonConfig& config) {
    load(program::shipped("thesis_case1.toml"),
         {"sim.model=" + program::shipped("models/thesis_calibrated.toml")}, config);
  }
  static void add_band(DaemonConfig& config) {
    estimator::fdi::BandConfig band;
    band.id = "far_out";
    band.quantity = "sample.y_m";
    band.high = 0.2;
    config.pipeline.bands.push_back(band);
  }
  std::shared_ptr<detection::DetectionUpdate> next_update() {
    std::shared_ptr<detection::DetectionUpdate> update;
    reloader_->to_detector.pop(update);
    return update;
  }

  rt::VirtualClock clock_;
  std::ostringstream log_;
  DaemonConfig running_;
  std::function<void(DaemonConfig&)> edit_ = [](DaemonConfig&) {};
  std::unique_ptr<Reloader> reloader_;
};

TEST_F(ReloaderTest, CompletesOnceTheDetectorHasAppliedTheUpdate) {
  edit_ = add_band;
  const std::size_t bands = running_.pipeline.bands.size();
  const std::string before = reloader_->config_hash();
  EXPECT_TRUE(reloader_->begin(0, "SIGHUP"));
  EXPECT_FALSE(reloader_->begin(0, "SIGHUP")) << "one at a time";
  reloader_->poll();
  EXPECT_TRUE(reloader_->busy());
  EXPECT_EQ(running_.pipeline.bands.size(), bands);

  const auto update = next_update();
  ASSERT_NE(update, nullptr);
  EXPECT_NE(update->pipeline, nullptr);
  update->warm = {"period"};
  reloader_->from_detector.push(update);
  reloader_->poll();
  EXPECT_FALSE(reloader_->busy());
  EXPECT_EQ(reloader_->last().reject_reason, "");
  EXPECT_THAT(reloader_->last().changed, testing::Contains("[[band]] far_out: high"));
  EXPECT_THAT(reloader_->last().warm, ElementsAre("period"));
  EXPECT_EQ(running_.pipeline.bands.size(), bands + 1);
  EXPECT_NE(reloader_->config_hash(), before);
  EXPECT_EQ(reloader_->complaint(), "");
  EXPECT_THAT(log_.str(), HasSubstr("new rules, configuration " + reloader_->config_hash()));
}

TEST_F(ReloaderTest, RejectsAChangeThatAffectsTheValve) {
  const double ramp_s = running_.safety.ramp_s;
  edit_ = [](DaemonConfig& config) { config.safety.ramp_s += 0.1; };
  EXPECT_TRUE(reloader_->begin(0, "SIGHUP"));
  EXPECT_FALSE(reloader_->busy());
  EXPECT_THAT(reloader_->last().reject_reason, HasSubstr("[safety] ramp_s: cannot change"));
  EXPECT_EQ(next_update(), nullptr);
  EXPECT_EQ(running_.safety.ramp_s, ramp_s);
  EXPECT_THAT(reloader_->complaint(), HasSubstr("the old configuration remains active: "));
}

TEST_F(ReloaderTest, KeepsTheOldConfigurationWhenTheNewOneCannotBeRead) {
  edit_ = [](DaemonConfig&) { throw config::schema::ConfigError("rig.toml:\nis missing"); };
  const std::string before = reloader_->config_hash();
  EXPECT_TRUE(reloader_->begin(0, "SIGHUP"));
  EXPECT_EQ(reloader_->last().reject_reason, "rig.toml: is missing") << "in one line";
  EXPECT_EQ(reloader_->config_hash(), before);

  edit_ = [](DaemonConfig&) {};
  EXPECT_TRUE(reloader_->begin(0, "SIGHUP")) << "a failed attempt does not block the next";
  EXPECT_THAT(next_update()->evidence_files, IsEmpty());
}

}  // namespace
}  // namespace monitor
