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
                                                           0, &commands_},
                                           running_, kSampleTime_s);
  }
  static void read(DaemonConfig& config) {
    load(program::shipped("thesis_case1.toml"),
         {"sim.model=" + program::shipped("models/thesis_calibrated.toml")}, config);
  }
  static control::GuardConfig travel(double high_m) {
    control::GuardConfig guard;
    guard.id = guard.kind = "travel";
    guard.high_m = high_m;
    return guard;
  }
  /// The limits on their way to the loop.
  rt::GuardUpdate* limits() {
    rt::LoopCommand command;
    return commands_.pop(command) && command.kind == rt::LoopCommand::Kind::guards ? command.guards
                                                                                   : nullptr;
  }
  /// A reload from a travel guard at 0.4 m to one at `high_m`, on its way to the loop.
  rt::GuardUpdate* begin_with_travel(double high_m) {
    running_.safety.guards = {travel(0.4)};
    edit_ = [high_m](DaemonConfig& config) { config.safety.guards = {travel(high_m)}; };
    EXPECT_TRUE(reloader_->begin(0, "SIGHUP"));
    EXPECT_TRUE(reloader_->busy()) << reloader_->last().reject_reason;
    return limits();
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
  rt::CommandQueue commands_;
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

TEST_F(ReloaderTest, SendsLimitsOfGuardsToTheLoopFirstAndThenToTheDetector) {
  rt::GuardUpdate* sent = begin_with_travel(0.35);
  ASSERT_NE(sent, nullptr);
  EXPECT_FALSE(sent->loosens);
  ASSERT_EQ(sent->guards.size(), control::kBuiltIn + 1);
  EXPECT_EQ(sent->guards.back().high(), 0.35);
  reloader_->poll();
  EXPECT_EQ(next_update(), nullptr) << "not before the loop has them";
  sent->outcome = rt::GuardUpdate::Outcome::applied;
  reloader_->poll();
  const auto update = next_update();
  ASSERT_NE(update, nullptr);
  EXPECT_EQ(update->guards.back().high_m, 0.35);
  reloader_->from_detector.push(update);
  reloader_->poll();
  EXPECT_EQ(reloader_->last().reject_reason, "");
  EXPECT_THAT(reloader_->last().changed, ElementsAre("[[guard]] travel: high_m"));
  EXPECT_EQ(running_.safety.guards[0].high_m, 0.35);
}

TEST_F(ReloaderTest, SaysWhichLimitLetsMorePassWhereTheLoopRefuses) {
  rt::GuardUpdate* sent = begin_with_travel(0.45);
  ASSERT_NE(sent, nullptr);
  EXPECT_TRUE(sent->loosens);
  sent->outcome = rt::GuardUpdate::Outcome::armed;
  reloader_->poll();
  EXPECT_FALSE(reloader_->busy());
  EXPECT_THAT(
      reloader_->last().reject_reason,
      HasSubstr("[[guard]] travel: high_m: lets more pass, which is refused while the rig is "
                "ARMED or in RUN; allowed: tighter limits; others after spoolwatch disarm"));
  EXPECT_EQ(next_update(), nullptr);
  EXPECT_EQ(running_.safety.guards[0].high_m, 0.4);
}

TEST_F(ReloaderTest, DoesNotWaitForEverForTheLoop) {
  ASSERT_NE(begin_with_travel(0.35), nullptr);
  clock_.advance_ns(400'000'000);
  reloader_->poll();
  EXPECT_TRUE(reloader_->busy());
  clock_.advance_ns(100'000'000);
  reloader_->poll();
  EXPECT_FALSE(reloader_->busy());
  EXPECT_THAT(reloader_->last().reject_reason, HasSubstr("did not take the limits"));
  EXPECT_EQ(running_.safety.guards[0].high_m, 0.4);
}

TEST_F(ReloaderTest, RejectsAnotherGuardAndAnotherAction) {
  running_.safety.guards = {travel(0.4)};
  for (const bool other : {true, false}) {
    edit_ = [other](DaemonConfig& config) {
      config.safety.guards = {travel(0.4)};
      config.safety.guards[0].action = other ? "latch" : "indicate";
      if (other)
        config.safety.guards.push_back(travel(0.35)), config.safety.guards[1].id = "second";
    };
    EXPECT_TRUE(reloader_->begin(0, "SIGHUP"));
    EXPECT_THAT(reloader_->last().reject_reason,
                HasSubstr(other ? "[[guard]] second: action: cannot change while the daemon runs"
                                : "[[guard]] travel: action: cannot change while the daemon runs"));
    EXPECT_EQ(limits(), nullptr);
  }
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
