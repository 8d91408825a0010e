// Messages beside a sample come back with it, whichever way the samples are read.
#include "workbench/replay/log_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/record/record.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "tests/daemon/program/subprocess.h"
#include "workbench/train/record_samples.h"

namespace workbench::replay {
namespace {

namespace fs = std::filesystem;
using config::signals::Sample;

/// Sample 3 has no pressures, and a rod sensor is missing from 5 on, where the other takes over.
Sample sample_of(int tick) {
  Sample sample;
  sample.tick = tick;
  sample.utc_us = 5000 * tick;
  sample.t_read_ns = 5'000'000 * tick;
  sample.y_m = 0.3 + 1e-3 * tick;
  sample.u_applied_V = 0.1 * tick;
  if (tick != 3) sample.pressures = {7e6 + tick, 4e6 + tick, 2e6 + tick};
  sample.rod_count = 2;
  sample.rod_in_charge = tick < 5 ? 0 : 1;
  sample.rod_changed = tick == 5;
  sample.rod_since = tick < 5 ? 0 : 5;
  sample.rod_m[0] = tick < 5 ? sample.y_m : std::nan("");
  sample.rod_m[1] = tick < 5 ? 0.4 : sample.y_m;
  if (tick >= 5) sample.rod_quality[0] = config::signals::Quality::bad;
  return sample;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void expect_beside(const Sample& found, const Sample& wanted) {
  EXPECT_TRUE(same(found.pressures.supply_Pa, wanted.pressures.supply_Pa)) << wanted.tick;
  EXPECT_TRUE(same(found.pressures.in_Pa, wanted.pressures.in_Pa)) << wanted.tick;
  EXPECT_TRUE(same(found.pressures.out_Pa, wanted.pressures.out_Pa)) << wanted.tick;
  EXPECT_EQ(found.rod_count, wanted.rod_count) << wanted.tick;
  EXPECT_EQ(found.rod_in_charge, wanted.rod_in_charge) << wanted.tick;
  EXPECT_EQ(found.rod_changed, wanted.rod_changed) << wanted.tick;
  EXPECT_EQ(found.rod_since, wanted.rod_since) << wanted.tick;
  EXPECT_EQ(found.rod_quality, wanted.rod_quality) << wanted.tick;
  for (std::size_t i = 0; i < wanted.rod_m.size(); ++i) {
    EXPECT_TRUE(same(found.rod_m[i], wanted.rod_m[i])) << wanted.tick << ' ' << i;
  }
}

/// The files of a recorded run of `ticks` samples, in their order.
std::vector<fs::path> record(const fs::path& folder, int ticks, std::int64_t file_bytes) {
  {
    monitor::io::RecorderConfig config;
    config.folder = folder;
    config.file_bytes = file_bytes;
    config.files = 1000;
    monitor::io::Recorder recorder(config, 3, false);
    monitor::io::Publisher publisher({.url = ""}, 3, 0.005, &recorder);
    publisher.enable_pressures();
    publisher.name_rods({"rod", "outer"});
    for (int tick = 0; tick < ticks; ++tick) publisher.sample(sample_of(tick));
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Collector final : public SampleHandler {
 public:
  std::vector<Sample> samples;

 private:
  void take(const Sample& sample, const spoolwatch::sample_t& /*message*/) override {
    samples.push_back(sample);
  }
};

TEST(LogWalk, KeepsASampleAndWhatIsToldBesideItTogetherAcrossFiles) {
  const program::Folder folder;
  const auto files = record(folder.path() / "log", 400, 4096);
  ASSERT_GT(files.size(), 30U) << "files end at any message";
  Collector together;
  for (const fs::path& file : files) walk_log(file, "SPOOLWATCH", together);
  ASSERT_EQ(together.samples.size(), 400U);
  for (int tick = 0; tick < 400; ++tick) {
    expect_beside(together.samples[static_cast<std::size_t>(tick)], sample_of(tick));
  }
}

TEST(RecordSamples, HaveTheRodsAndThePressuresOfTheirColumns) {
  const program::Folder folder;
  const auto files = record(folder.path() / "log", 10, 1 << 20);
  const std::vector<Sample> samples = train::to_samples(config::record::read_record(files.at(0)));
  ASSERT_EQ(samples.size(), 10U);
  for (int tick = 0; tick < 10; ++tick) {
    expect_beside(samples[static_cast<std::size_t>(tick)], sample_of(tick));
  }
}

TEST(RecordSamples, HaveNeitherWhereARecordHasNeither) {
  config::record::Record record;
  record.sample_time_s = 0.01;
  record.t_s = {0.0, 0.01, 0.02};
  record.u_V = record.y_m = {0.0, 1.0, 2.0};
  for (const Sample& sample : train::to_samples(record)) {
    EXPECT_EQ(sample.rod_count, 0);
    EXPECT_TRUE(std::isnan(sample.pressures.supply_Pa));
    EXPECT_FALSE(sample.pressures.chambers());
  }
}

}  // namespace
}  // namespace workbench::replay
