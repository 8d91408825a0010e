// The history of the alarms on a disk that does not take it, and what is left of it at the end.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/io/alarm_store.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/file_size_limit.h"

namespace monitor::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class AlarmHistory : public testing::Test {
 protected:
  AlarmHistory() { block(); }

  void block() const { fs::create_directory(path()); }  // in the way, as a full disk is
  void free() const { fs::remove(path()); }
  [[nodiscard]] fs::path path() const { return folder_.path() / "history.log"; }

  static bool waits(const AlarmStore& store, std::size_t lines) {
    for (int i = 0; i < 1000 && store.waiting_history() != lines; ++i) usleep(2000);
    return store.waiting_history() == lines;
  }
  /// An alarm that comes and goes, behind the start of the daemon.
  static void change(AlarmStore& store, std::size_t times) {
    estimator::fdi::Alarm alarm;
    alarm.source = "loop";
    alarm.name = "n";
    for (std::size_t i = 1; i <= times; ++i) {
      alarm.active = !alarm.active;
      store.note(alarm, 1'000'000 * static_cast<std::int64_t>(i));
      if (i % 100 == 0) {
        ASSERT_TRUE(waits(store, 1 + i));  // the writer's queue is shorter
      }
    }
    ASSERT_TRUE(waits(store, 1 + times));
  }
  [[nodiscard]] static std::vector<json> lines_of(const fs::path& file) {
    std::ifstream in(file);
    std::vector<json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
    return lines;
  }
  /// All lines: the start, `changes` in their order, the end.
  void expect_whole(std::size_t changes) const {
    const std::vector<json> lines = lines_of(path());
    ASSERT_EQ(lines.size(), changes + 2);
    EXPECT_EQ(lines.front().value("event", ""), "start");
    EXPECT_EQ(lines.back().value("event", ""), "end");
    const auto earlier = [](const json& a, const json& b) { return a.at("utc") < b.at("utc"); };
    EXPECT_TRUE(std::is_sorted(lines.begin() + 1, lines.end(), earlier));
    EXPECT_EQ(std::adjacent_find(lines.begin(), lines.end()), lines.end()) << "none twice";
  }

  program::Folder folder_;
  BackgroundWriter writer_;
};

constexpr std::size_t kMany = 1200;  // more than twice as many as are written together

TEST_F(AlarmHistory, IsWrittenWholeAtTheEndWhenTheDiskHasRoomAgain) {
  {
    AlarmStore store(folder_.path(), "rig", writer_);
    change(store, kMany);
    free();
    EXPECT_EQ(store.finish(), 0);
    expect_whole(kMany);
  }
  writer_.finish();
  expect_whole(kMany);
}

TEST_F(AlarmHistory, IsWrittenWholeThoughNobodyWaitsForIt) {
  {
    AlarmStore store(folder_.path(), "rig", writer_);
    change(store, kMany);
    free();
  }
  writer_.finish();
  expect_whole(kMany);
}

TEST_F(AlarmHistory, CountsAtTheEndWhatAFullDiskHasNotTaken) {
  AlarmStore store(folder_.path(), "rig", writer_);
  change(store, 200);
  EXPECT_EQ(store.finish(), 202) << "with the start and the end";
}

TEST_F(AlarmHistory, EndsInTimeThoughTheDiskIsSlow) {
  AlarmStore store(folder_.path(), "rig", writer_);
  change(store, 200);
  free();
  EXPECT_EQ(store.finish(std::chrono::milliseconds(0)), 202);
}

TEST_F(AlarmHistory, StaysWithinItsSizeWhateverHasWaited) {
  AlarmStore store(folder_.path(), "rig", writer_, 4096);
  change(store, kMany);
  free();
  EXPECT_EQ(store.finish(), 0);
  const auto newest = fs::file_size(path());
  const auto before = fs::file_size(path().string() + ".1");
  EXPECT_LE(newest, 4096U);
  EXPECT_LE(before, 4096U);
  EXPECT_GT(newest + before, 4096U);
  EXPECT_EQ(lines_of(path()).back().value("event", ""), "end");
}

TEST_F(AlarmHistory, TakesAsManyLinesAsANearlyFullDisk) {
  constexpr std::size_t kChanges = 600;
  AlarmStore store(folder_.path(), "rig", writer_);
  change(store, kChanges);
  free();
  constexpr std::size_t kRoom_bytes = 10'000;
  {
    const tests::FileSizeLimit limit(kRoom_bytes);
    store.retry_history();
    for (int i = 0; i < 1000 && store.waiting_history() > kChanges; ++i) usleep(2000);
  }
  const auto size = fs::file_size(path());
  EXPECT_LE(size, kRoom_bytes);
  EXPECT_GT(size, kRoom_bytes - 200) << "not even one line more";
  EXPECT_EQ(store.finish(), 0);
  expect_whole(kChanges);
}

}  // namespace
}  // namespace monitor::io
