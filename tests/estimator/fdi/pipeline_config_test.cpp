#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {
namespace {

using config::schema::Document;
using config::schema::Visitor;

constexpr const char* kText = R"(schema_version = 1
bands_file = "bands.toml"
[[estimator]]
id = "sliding"
structure = "arx211"
method = "sliding"
window_s = 0.3
[[band]]
id = "supply"
quantity = "sliding.b1"
severity = "minor"
)";

PipelineConfig read(const std::string& text) {
  PipelineConfig config;
  Document::parse(text, "test.toml").read([&](Visitor& v) { config.visit(v); });
  return config;
}

class LearnedBandsFile : public testing::Test {
 protected:
  LearnedBandsFile()
      : folder_(testing::TempDir() + "/spoolwatch_bands_" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
    learned_.sample_time_s = 0.005;
    learned_.source = "healthy.csv";
    LearnedBand band;
    band.quantity = "sliding.b1";
    band.structure = "arx211";
    band.estimator = config_.estimators[0].fingerprint();
    band.low = 1.0;
    band.high = 2.0;
    band.hysteresis = 0.05;
    learned_.bands.push_back(band);
  }
  ~LearnedBandsFile() override { std::filesystem::remove_all(folder_); }

  void load(double sample_time_s) {
    std::ofstream(folder_ / "bands.toml")
        << config::schema::print_toml([&](Visitor& v) { learned_.visit(v); });
    config_.load_bands(folder_, sample_time_s);
  }
  void expect_refused(double sample_time_s, const std::string& part) {
    try {
      load(sample_time_s);
      FAIL() << "not refused";
    } catch (const config::schema::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  std::filesystem::path folder_;
  PipelineConfig config_ = read(kText);
  LearnedBands learned_;
};

TEST_F(LearnedBandsFile, GivesItsLimitsToTheBandThatHasNone) {
  load(0.005);
  ASSERT_EQ(config_.bands.size(), 1U);
  EXPECT_EQ(config_.bands[0].low, 1.0);
  EXPECT_EQ(config_.bands[0].high, 2.0);
  EXPECT_EQ(config_.bands[0].hysteresis, 0.05);
  EXPECT_EQ(config_.bands[0].severity, "minor");
}

TEST_F(LearnedBandsFile, LeavesGivenLimitsAloneAndAddsABandOfItsOwn) {
  config_.bands[0].high = 9.0;
  load(0.005);
  ASSERT_EQ(config_.bands.size(), 2U);
  EXPECT_EQ(config_.bands[0].high, 9.0);
  EXPECT_EQ(config_.bands[1].id, "sliding.b1.learned");
  EXPECT_EQ(config_.bands[1].high, 2.0);
}

TEST_F(LearnedBandsFile, IsRefusedAtAnotherSampleTime) { expect_refused(0.002, "sample_time_s"); }

TEST_F(LearnedBandsFile, IsRefusedForAnEstimatorWithOtherSettings) {
  config_.estimators[0].window_s = 0.5;
  expect_refused(0.005, "other settings");
}

TEST_F(LearnedBandsFile, IsRefusedForAnEstimatorThatDoesNotExist) {
  config_.estimators[0].id = "another";
  expect_refused(0.005, "no such estimator");
}

TEST(PipelineConfig, MeansTheSameAfterPrintingAndReading) {
  PipelineConfig config = read(kText);
  const std::string printed = config::schema::print_toml([&](Visitor& v) { config.visit(v); });
  PipelineConfig again = read(printed);
  EXPECT_EQ(config::schema::print_toml([&](Visitor& v) { again.visit(v); }), printed);
  EXPECT_NE(printed.find("structure = \"arx211\""), std::string::npos);
}

TEST(PipelineConfig, RefusesAnUnknownKeyWithItsPlace) {
  try {
    read("schema_version = 1\n[[estimator]]\nid = \"a\"\nwindow = 2.0\n");
    FAIL();
  } catch (const config::schema::Error& error) {
    EXPECT_NE(std::string(error.what()).find("test.toml:4"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("window_s"), std::string::npos);
  }
}

}  // namespace
}  // namespace estimator::fdi
