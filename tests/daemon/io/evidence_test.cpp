// Evidence on disk: what a folder holds, how many there may be, a disk that is full.
#include "daemon/io/evidence.h"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "config/signals/sample.h"
#include "daemon/io/publisher.h"
#include "spoolwatch/sample_t.hpp"
#include "tests/daemon/io/log_reader.h"

namespace monitor::io {
namespace {

namespace fs = std::filesystem;
using estimator::fdi::Alarm;
using estimator::fdi::Severity;

constexpr double kSampleTime_s = 0.005;

template <class Message>
Message decode(const Event& event) {
  Message message{};
  EXPECT_GE(message.decode(event.data.data(), 0, static_cast<int>(event.data.size())), 0);
  return message;
}

class EvidenceTest : public testing::Test {
 protected:
  EvidenceTest() {
    std::string name = (fs::temp_directory_path() / "evidence-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    config_.folder = (folder_ / "e").string();
    config_.before_s = 1.0;
    config_.after_s = 0.5;
    config_.memory_bytes = 1 << 20;
  }
  ~EvidenceTest() override { fs::remove_all(folder_); }

  [[nodiscard]] std::unique_ptr<Evidence> make(bool background = false) const {
    return std::make_unique<Evidence>(
        config_, EvidenceFacts{"rig", "hash", "T", 7, kSampleTime_s, {{"model.toml", "m = 1\n"}}},
        background);
  }
  /// Samples from..to, a snapshot whenever one is due.
  static void run(Evidence& evidence, Publisher& publisher, std::int64_t from, std::int64_t to) {
    config::signals::Sample sample;
    for (sample.tick = from; sample.tick < to; ++sample.tick) {
      const std::vector<std::uint8_t> state(100, static_cast<std::uint8_t>(sample.tick));
      if (evidence.wants_state(sample.tick)) evidence.state(state, sample.tick);
      sample.utc_us = 5000 * sample.tick;
      publisher.sample(sample);
    }
  }
  static void raise(Evidence& evidence, std::int64_t tick, const char* name = "n") {
    Alarm alarm;
    alarm.source = "s/../x";  // a name is no path
    alarm.name = name;
    alarm.tick = tick;
    alarm.severity = Severity::major;
    alarm.value = 0.1;
    evidence.alarm(alarm, 5000 * tick);
  }
  [[nodiscard]] std::vector<fs::path> packs() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(config_.folder)) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }
  static nlohmann::json manifest(const fs::path& pack) {
    std::ifstream in(pack / "pack.json");
    return nlohmann::json::parse(in);
  }

  fs::path folder_;
  EvidenceConfig config_;
};

TEST_F(EvidenceTest, HoldsWhatCameBeforeAndAfterTheAlarmFromASnapshotOn) {
  const auto evidence = make();
  Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
  publisher.attach(*evidence);
  run(*evidence, publisher, 0, 1001);
  raise(*evidence, 1000);
  run(*evidence, publisher, 1001, 1101);
  EXPECT_TRUE(packs().empty()) << "0.5 s after it have not passed";
  run(*evidence, publisher, 1101, 2000);
  ASSERT_EQ(packs().size(), 1U);
  const fs::path pack = packs().front();
  EXPECT_EQ(pack.filename(), "alarm-1970-01-01T00_00_05Z-s_.._x.n-1000");
  const auto whole = manifest(pack);
  // Snapshots come each second; 200 samples before 1000 is 800, where there is one.
  EXPECT_EQ(whole["first_tick"], 800);
  EXPECT_EQ(whole["last_tick"], 1101);
  EXPECT_EQ(whole["exact"], true);
  EXPECT_EQ(whole["alarm"]["value_bits"], "3fb999999999999a");
  const auto events = read_events(pack / "log.lcmlog");
  ASSERT_EQ(events.size(), 302U);
  EXPECT_EQ(decode<spoolwatch::sample_t>(events.front()).tick, 800);
  EXPECT_EQ(decode<spoolwatch::sample_t>(events.back()).tick, 1101);
  std::ifstream state(pack / "state.bin");
  const std::string bytes{std::istreambuf_iterator<char>(state), {}};
  EXPECT_EQ(bytes, std::string(100, static_cast<char>(800 & 0xff)));
  EXPECT_TRUE(fs::exists(pack / "model.toml"));
  EXPECT_EQ(evidence->status().written, 1);
}

TEST_F(EvidenceTest, IsBoundedInNumberAndInBytesTheOldestGoFirst) {
  config_.packs = 3;
  {
    const auto evidence = make();
    Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
    publisher.attach(*evidence);
    for (std::int64_t tick = 0; tick < 10'000; tick += 1000) {
      run(*evidence, publisher, tick, tick + 501);
      raise(*evidence, tick + 500);
      run(*evidence, publisher, tick + 501, tick + 1000);
    }
    EXPECT_EQ(evidence->status().written, 10);
  }
  ASSERT_EQ(packs().size(), 3U);
  EXPECT_THAT(packs().front().string(), testing::EndsWith("-7500"));
  config_.total_bytes = 1 << 20;  // its least
  fs::resize_file(packs().back() / "log.lcmlog", 900'000);
  fs::resize_file(packs()[1] / "log.lcmlog", 900'000);
  fs::create_directory(fs::path(config_.folder) / ".partial-x");
  make()->finish();
  ASSERT_EQ(packs().size(), 1U) << "too large, and what was half written";
  EXPECT_THAT(packs().front().string(), testing::EndsWith("-9500"));
}

TEST_F(EvidenceTest, KeepsWhatBelongsToTwoConfigurationsApart) {
  const auto evidence = make();
  Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
  publisher.attach(*evidence);
  run(*evidence, publisher, 0, 501);
  raise(*evidence, 500);
  run(*evidence, publisher, 501, 510);
  evidence->reconfigure({{"model.toml", "m = 2\n"}});
  run(*evidence, publisher, 510, 561);
  raise(*evidence, 560);
  run(*evidence, publisher, 561, 700);
  ASSERT_EQ(packs().size(), 2U);
  const auto model = [](const fs::path& pack) { return bytes_of(pack / "model.toml"); };
  EXPECT_EQ(manifest(packs()[0])["last_tick"], 509);
  EXPECT_EQ(model(packs()[0]), "m = 1\n");
  EXPECT_EQ(manifest(packs()[1])["first_tick"], 510);
  EXPECT_EQ(model(packs()[1]), "m = 2\n");
}

TEST_F(EvidenceTest, SaysWhenItsMemoryWasTooSmall) {
  config_.before_s = 600.0;  // with 1 MiB
  const auto evidence = make();
  Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
  publisher.attach(*evidence);
  run(*evidence, publisher, 0, 30'001);
  raise(*evidence, 30'000);
  run(*evidence, publisher, 30'001, 30'200);
  ASSERT_EQ(packs().size(), 1U);
  EXPECT_EQ(manifest(packs().front())["exact"], false);
  EXPECT_FALSE(fs::exists(packs().front() / "state.bin"));
}

TEST_F(EvidenceTest, ThatCannotBeWrittenIsCountedAndLeavesNothingBehind) {
  const auto evidence = make();
  Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
  publisher.attach(*evidence);
  run(*evidence, publisher, 0, 1001);
  raise(*evidence, 1000);
  struct rlimit before {};
  getrlimit(RLIMIT_FSIZE, &before);
  const struct rlimit small { 8192, before.rlim_max };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  run(*evidence, publisher, 1001, 1200);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(evidence->status().failed, 1);
  EXPECT_EQ(evidence->status().error, EFBIG);
  EXPECT_TRUE(packs().empty());
  raise(*evidence, 1199);
  run(*evidence, publisher, 1200, 1400);
  EXPECT_EQ(packs().size(), 1U) << "it goes on when there is room again";
}

TEST_F(EvidenceTest, OfABurstIsWrittenInTheBackgroundAsFarAsFoldersMayWait) {
  const auto evidence = make(true);
  Publisher publisher({"", "T"}, 7, kSampleTime_s, nullptr);
  publisher.attach(*evidence);
  run(*evidence, publisher, 0, 1001);
  for (int i = 0; i < 20; ++i) raise(*evidence, 1000, ("n" + std::to_string(i)).c_str());
  evidence->finish();
  EXPECT_EQ(evidence->status().written, 16);
  EXPECT_EQ(evidence->status().skipped, 4);
  EXPECT_EQ(evidence->status().dropped, 0);
  EXPECT_EQ(packs().size(), 16U);
}

}  // namespace
}  // namespace monitor::io
