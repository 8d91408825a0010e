#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/trained.h"
#include "tests/estimator/fdi/recorder.h"
#include "tests/estimator/fdi/small_rig.h"
#include "tests/workbench/run_command.h"
#include "workbench/train/learn.h"

namespace workbench {
namespace {

namespace fdi = estimator::fdi;
using config::schema::Document;
using config::schema::Visitor;

constexpr const char* kConfig = R"(schema_version = 1
[rig]
id = "small"
[loop]
sample_time_s = 0.005
[[estimator]]
id = "sliding"
structure = "arx111"
method = "sliding"
window_s = 1.0
stride_s = 0.02
offset_m = 0.305
warmup_s = 2.0
[[cusum]]
id = "gain"
quantity = "sliding.b1"
block_s = 2.0
file = "trained.toml"
[[distance]]
id = "healthy"
features = ["sliding.a1", "sliding.b1"]
block_s = 2.0
file = "trained.toml"
[[classifier]]
id = "fault"
features = ["sliding.a1", "sliding.b1"]
block_s = 2.0
file = "trained.toml"
)";

class Train : public testing::Test {
 protected:
  Train() {
    std::filesystem::create_directories(folder_);
    write_config(kConfig);
  }
  ~Train() override { std::filesystem::remove_all(folder_); }

  void write_config(const std::string& text) { std::ofstream(folder_ / "config.toml") << text; }
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = kConfig;
    return text.replace(text.find(from), from.size(), to);
  }
  static std::vector<fdi::Sample> samples(const small_rig::Setup& setup, double duration_s) {
    std::vector<fdi::Sample> all;
    small_rig::Rig rig(setup);
    while (rig.time_s() < duration_s) all.push_back(rig.step());
    return all;
  }
  void record(const std::string& name, const small_rig::Setup& setup, double duration_s) {
    config::record::Record record;
    for (const fdi::Sample& sample : samples(setup, duration_s)) {
      record.t_s.push_back(static_cast<double>(sample.tick) * small_rig::kSampleTime_s);
      record.u_V.push_back(sample.u_applied_V);
      record.y_m.push_back(sample.y_m);
    }
    config::record::write_csv(record, folder_ / name);
  }
  void train_all(double duration_s = 70.0) {
    record("healthy.csv", {}, duration_s);
    record("high.csv", {.supply_Pa = 1.1 * 6.89e6, .seed = 2}, duration_s);
    record("low.csv", {.supply_Pa = 0.9 * 6.89e6, .seed = 3}, duration_s);
    train({"--class", "supply+=" + (folder_ / "high.csv").string(), "--class",
           "supply-=" + (folder_ / "low.csv").string()});
  }
  void train(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{folder_ / "config.toml", "--healthy",
                                       folder_ / "healthy.csv", "-o", folder_ / "trained.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    printed_ = workbench_test::printed_by(add_train, arguments);
  }
  fdi::PipelineConfig loaded(const std::string& rig_id = "small", double sample_time_s = 0.005) {
    fdi::PipelineConfig config;
    Document::load(folder_ / "config.toml").read_part([&](Visitor& v) { config.visit(v); });
    config.load_bands(folder_, sample_time_s, rig_id);
    return config;
  }
  /// What loading it is refused with; the exit code must be 78.
  std::string refusal(const std::string& rig_id = "small", double sample_time_s = 0.005) {
    try {
      (void)loaded(rig_id, sample_time_s);
    } catch (const config::schema::Error& error) {
      return error.exit_code() == 78 ? error.what() : "another exit code";
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("train_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::string printed_;
};

TEST_F(Train, TeachesOneCommandWhatChangedInARecordNotSeenBefore) {
  train_all();
  EXPECT_NE(printed_.find("[[classifier]] fault: blocks of 2 s: healthy"), std::string::npos)
      << printed_;
  fdi::Pipeline pipeline(loaded(), 0.005);
  fdi_test::Recorder seen;
  const auto run = [&](const small_rig::Setup& setup) {
    pipeline.reset();
    seen.alarms.clear();
    for (const fdi::Sample& sample : samples(setup, 30.0)) pipeline.process(sample, seen);
  };
  run({.seed = 77});
  EXPECT_TRUE(seen.alarms.empty()) << seen.alarms.front().source << seen.alarms.front().reason;
  run({.supply_Pa = 0.9 * 6.89e6, .seed = 78});
  bool named = false;
  for (const fdi::Alarm& alarm : seen.alarms) {
    EXPECT_EQ(alarm.direction, alarm.source == "healthy" ? 1 : -1) << alarm.source;
    named = named || (alarm.source == "fault" && alarm.parameter == "supply");
  }
  EXPECT_TRUE(named);
  EXPECT_EQ(pipeline.alarms().active_count(), 3U) << "shifted, outside, and named";
  // Half way between what it was taught is none of these.
  run({.supply_Pa = 1.05 * 6.89e6, .seed = 79});
  const fdi::AlarmBook& book = pipeline.alarms();
  EXPECT_NE(book.alarm(book.find("fault.fault")).reason.find("none of these"), std::string::npos);
}

TEST_F(Train, IsRefusedForAnotherRigSampleTimeOrEstimatorInOneLineWithExitCode78) {
  train_all();
  EXPECT_EQ(refusal(), "");
  EXPECT_NE(refusal("other").find("was trained on rig 'small', this is 'other'"),
            std::string::npos);
  EXPECT_NE(refusal("small", 0.004).find("was trained at 0.005"), std::string::npos);
  write_config(with("window_s = 1.0", "window_s = 0.5"));
  EXPECT_NE(refusal().find("sliding.b1 was trained with other settings"), std::string::npos);
  write_config(with("block_s = 2.0", "block_s = 1.0"));
  EXPECT_NE(refusal().find("other quantities or blocks"), std::string::npos);
  write_config(with("id = \"gain\"", "id = \"new\""));
  EXPECT_NE(refusal().find("knows nothing of [[cusum]] new"), std::string::npos);
  write_config(kConfig);
  std::ifstream in(folder_ / "trained.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  text.replace(text.find("trained_version = 1"), 19, "trained_version = 2");
  std::ofstream(folder_ / "trained.toml") << text;
  EXPECT_NE(refusal().find("trained_version"), std::string::npos);
}

TEST_F(Train, LeavesTheOldFileWhenARecordIsTooShort) {
  std::ofstream(folder_ / "trained.toml") << "old";
  record("healthy.csv", {}, 20.0);
  try {
    train();
    FAIL();
  } catch (const config::schema::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    EXPECT_NE(std::string(error.what()).find("20 or more"), std::string::npos) << error.what();
  }
  std::ifstream in(folder_ / "trained.toml");
  EXPECT_EQ(std::string((std::istreambuf_iterator<char>(in)), {}), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 3);
}

TEST_F(Train, SaysThatNothingIsTrained) {
  std::string text = kConfig;
  write_config(text.substr(0, text.find("[[cusum]]")));
  record("healthy.csv", {}, 5.0);
  try {
    train();
    FAIL();
  } catch (const config::schema::Error& error) {
    EXPECT_EQ(error.exit_code(), 78);
  }
}

TEST(Summary, OfBlocksIsMeanCovarianceAndTheDeviationThatCountsOverLongRuns) {
  // x(t) = e(t) + e(t-1): variance 2, over long runs 4; y = -x.
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  train::Blocks blocks(2);
  for (auto& rows : blocks) {
    double before = normal(random);
    for (int i = 0; i < 20000; ++i) {
      const double e = normal(random);
      rows.push_back({5.0 + e + before, -e - before});
      before = e;
    }
  }
  const fdi::TrainedClass found = train::summarise(blocks, {"healthy", 0, {}}, "here");
  EXPECT_EQ(found.blocks, 40000);
  EXPECT_NEAR(found.mean[0], 5.0, 4.0 * 2.0 / std::sqrt(40000.0));
  EXPECT_NEAR(found.covariance[0], 2.0, 0.08);
  EXPECT_NEAR(found.covariance[1], -2.0, 0.08);
  // Bartlett's weights leave out 2/(L + 1) of the lag-1 part, L = 15: 2 + 2 (15/16) = 3.875.
  EXPECT_NEAR(found.long_run[0], std::sqrt(3.875) * (1.0 + 1.645 / std::sqrt(80000.0)), 0.06);
}

}  // namespace
}  // namespace workbench
