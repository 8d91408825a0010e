// A rig's configuration with the methods to train, records of the small rig, and the command.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/trained.h"
#include "tests/estimator/fdi/small_rig.h"
#include "tests/workbench/run_command.h"
#include "workbench/train/learn.h"

namespace workbench::train {

namespace fdi = estimator::fdi;
using config::schema::Document;
using config::schema::Visitor;

inline constexpr const char* kConfig = R"(schema_version = 1
[rig]
id = "small"
calibration = "calibration.toml"
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
  static std::vector<config::signals::Sample> samples(const small_rig::Setup& setup,
                                                      double duration_s) {
    std::vector<config::signals::Sample> all;
    small_rig::Rig rig(setup);
    while (rig.time_s() < duration_s) all.push_back(rig.step());
    return all;
  }
  void record(const std::string& name, const small_rig::Setup& setup, double duration_s) {
    config::record::Record record;
    for (const config::signals::Sample& sample : samples(setup, duration_s)) {
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
    printed_ = workbench_test::printed_by(workbench::cli::add_train, arguments);
  }
  fdi::PipelineConfig loaded(const std::string& rig_id = "small", double sample_time_s = 0.005) {
    fdi::PipelineConfig config;
    Document::load(folder_ / "config.toml").read_part([&](Visitor& v) { config.visit(v); });
    config.load_bands(folder_, sample_time_s, rig_id);
    return config;
  }
  /// The refusal of loading it: one line that names the file, exit code 78.
  std::string refusal(const std::string& rig_id = "small", double sample_time_s = 0.005) {
    try {
      (void)loaded(rig_id, sample_time_s);
    } catch (const config::schema::ConfigError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("train_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::string printed_;
};

}  // namespace workbench::train
