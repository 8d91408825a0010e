#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/pipeline.h"
#include "tests/estimator/fdi/recorder.h"
#include "tests/estimator/fdi/small_rig.h"
#include "tests/workbench/run_command.h"

namespace workbench::cli {
namespace {

namespace fdi = estimator::fdi;
using config::schema::Document;
using config::schema::Visitor;

/// Tables of the daemon stand beside the pipeline's, as in a real configuration.
constexpr const char* kConfig = R"(schema_version = 1
bands_file = "bands.toml"
[loop]
sample_time_s = 0.005
[[estimator]]
id = "sliding"
structure = "arx111"
method = "sliding"
window_s = 0.5
stride_s = 0.02
offset_m = 0.305
warmup_s = 2.0
[[band]]
id = "supply"
quantity = "sliding.b1"
on_delay_s = 0.1
)";

class Calibrate : public testing::Test {
 protected:
  Calibrate() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "config.toml") << kConfig;
  }
  ~Calibrate() override { std::filesystem::remove_all(folder_); }

  void record(double duration_s) {
    config::record::Record record;
    small_rig::Rig rig({});
    while (rig.time_s() < duration_s) {
      record.t_s.push_back(rig.time_s());
      const config::signals::Sample sample = rig.step();
      record.u_V.push_back(sample.u_applied_V);
      record.y_m.push_back(sample.y_m);
    }
    config::record::write_csv(record, folder_ / "healthy.csv");
  }
  void calibrate(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{folder_ / "config.toml", folder_ / "healthy.csv", "-o",
                                       folder_ / "bands.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    printed_ = workbench_test::printed_by(workbench::cli::add_calibrate, arguments);
  }
  fdi::PipelineConfig loaded() {
    fdi::PipelineConfig config;
    Document::load(folder_ / "config.toml").read_part([&](Visitor& v) { config.visit(v); });
    config.load_bands(folder_, small_rig::kSampleTime_s);
    return config;
  }

  std::filesystem::path folder_ =
      testing::TempDir() + "/spoolwatch_calibrate_" + std::to_string(getpid());
  std::string printed_;
};

TEST_F(Calibrate, LearnsABandThatIsSilentOnOtherHealthyDataAndSeesAFiveHundredthsFault) {
  record(120.0);
  calibrate({"--false-alarm-time-s", "86400"});
  const fdi::PipelineConfig config = loaded();
  ASSERT_EQ(config.bands.size(), 1U);
  EXPECT_LT(config.bands[0].high - config.bands[0].low, 0.03 * 1.967e-4);

  small_rig::Setup setup;
  setup.seed = 99;
  small_rig::Rig rig(setup);
  fdi::Pipeline pipeline(config, small_rig::kSampleTime_s);
  fdi_test::Recorder seen;
  while (rig.time_s() < 600.0) pipeline.process(rig.step(), seen);
  EXPECT_TRUE(seen.alarms.empty());
  rig.supply_Pa *= 0.95;  // b1 falls by 2.5 %
  while (rig.time_s() < 602.0) pipeline.process(rig.step(), seen);
  ASSERT_FALSE(seen.alarms.empty());
  EXPECT_EQ(seen.alarms.back().direction, -1);
}

TEST_F(Calibrate, WritesWhereTheBandsCameFrom) {
  record(60.0);
  calibrate();
  fdi::LearnedBands learned;
  Document::load(folder_ / "bands.toml").read([&](Visitor& v) { learned.visit(v); });
  EXPECT_NEAR(learned.sample_time_s, 0.005, 1e-12);
  EXPECT_EQ(learned.source, folder_ / "healthy.csv");
  EXPECT_EQ(learned.false_alarm_time_s, 86400.0);
  ASSERT_EQ(learned.bands.size(), 1U);
  EXPECT_EQ(learned.bands[0].quantity, "sliding.b1");
  EXPECT_EQ(learned.bands[0].structure, "arx111");
  EXPECT_DOUBLE_EQ(learned.bands[0].block_s, 2.0);  // one period of the motion
  EXPECT_NE(printed_.find("sliding.b1"), std::string::npos);
}

TEST_F(Calibrate, RefusesAHealthyRecordThatIsTooShort) {
  record(15.0);
  try {
    calibrate();
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_NE(std::string(error.what()).find("too short"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bands.toml"));
}

TEST_F(Calibrate, RefusesAQuantityThatNoEstimatorGives) {
  record(15.0);
  for (const char* quantity : {"period.b1", "sliding.b2", "sliding.", "b1"}) {
    try {
      calibrate({"--quantity", quantity});
      FAIL() << quantity;
    } catch (const config::schema::ConfigError& error) {
    }
  }
}

}  // namespace
}  // namespace workbench::cli
