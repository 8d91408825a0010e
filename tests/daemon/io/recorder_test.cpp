#include "daemon/io/recorder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>

#include "config/schema/error.h"
#include "tests/daemon/io/log_reader.h"

namespace monitor::io {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kRun = 7;

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    std::string name = (fs::temp_directory_path() / "recorder-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    config_.folder = folder_;
  }
  ~RecorderTest() override { fs::remove_all(folder_); }

  static void record(Recorder& recorder, int number, std::size_t size = 100) {
    std::string data = std::to_string(number) + ":";
    data.resize(size, static_cast<char>('a' + number % 26));
    recorder.record("SPOOLWATCH_SAMPLE",
                    {reinterpret_cast<const std::uint8_t*>(data.data()), data.size()},
                    1000 * number);
  }
  static int number_of(const Event& event) { return std::stoi(event.data); }
  static void expect_whole(const fs::path& file) {
    std::uintmax_t size = 0;
    std::int64_t number = 0;
    for (const Event& event : read_events(file)) {
      size += size_of(event);
      EXPECT_EQ(event.number, number++);
    }
    EXPECT_EQ(size, fs::file_size(file)) << "part of an event at the end of " << file;
  }
  template <class Condition>
  static bool wait_for(Condition condition) {
    for (int i = 0; i < 1000 && !condition(); ++i) ::usleep(10'000);
    return condition();
  }

  fs::path folder_;
  RecorderConfig config_;
};

TEST_F(RecorderTest, WritesLogsThatLcmReadsBackUnchanged) {
  {
    Recorder recorder(config_, kRun, false);
    for (int i = 0; i < 50; ++i) record(recorder, i, 20 + static_cast<std::size_t>(i));
  }
  ASSERT_EQ(logs_in(folder_).size(), 1U);
  EXPECT_EQ(logs_in(folder_)[0].filename(), "spoolwatch-7-00000.lcmlog");
  const auto events = read_events(logs_in(folder_)[0]);
  ASSERT_EQ(events.size(), 50U);
  for (int i = 0; i < 50; ++i) {
    const Event& event = events[static_cast<std::size_t>(i)];
    EXPECT_EQ(event.number, i);
    EXPECT_EQ(event.utc_us, 1000 * i);
    EXPECT_EQ(event.channel, "SPOOLWATCH_SAMPLE");
    EXPECT_EQ(number_of(event), i);
    EXPECT_EQ(event.data.size(), 20U + static_cast<std::size_t>(i));
  }
}

TEST_F(RecorderTest, WritesTheSameBytesInVirtualTimeAsInTheBackground) {
  config_.file_bytes = 4096;
  std::vector<std::string> written[2];
  for (const bool background : {false, true}) {
    config_.folder = folder_ / (background ? "b" : "a");
    {
      Recorder recorder(config_, kRun, background);
      for (int i = 0; i < 200; ++i) record(recorder, i, 20 + static_cast<std::size_t>(i % 90));
    }
    for (const auto& file : logs_in(config_.folder)) {
      written[background ? 1 : 0].push_back(bytes_of(file));
    }
  }
  EXPECT_GT(written[0].size(), 3U);
  EXPECT_EQ(written[0], written[1]);
}

TEST_F(RecorderTest, RotatesBelowTheCapAndKeepsTheNewestFiles) {
  config_.file_bytes = 4096;
  config_.files = 3;
  std::ofstream(folder_ / "notes.txt") << "not a log";
  {
    Recorder recorder(config_, kRun, false);
    for (int i = 0; i < 300; ++i) record(recorder, i);
    record(recorder, 300, 10'000);  // larger than the cap: a file of its own
  }
  EXPECT_TRUE(fs::exists(folder_ / "notes.txt"));
  fs::remove(folder_ / "notes.txt");
  const auto files = logs_in(folder_);
  ASSERT_EQ(files.size(), 3U);
  std::vector<int> numbers;
  for (const auto& file : files) {
    expect_whole(file);
    const auto events = read_events(file);
    if (events.size() > 1) {
      EXPECT_LE(fs::file_size(file), 4096U);
    }
    for (const Event& event : events) numbers.push_back(number_of(event));
  }
  // The newest, without a hole between files.
  EXPECT_EQ(numbers.back(), 300);
  for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], numbers[i - 1] + 1);
}

TEST_F(RecorderTest, KeepsItsOwnNewestLogsWhenTheWallClockWasSetBack) {
  config_.file_bytes = 4096;
  config_.files = 4;
  const auto later = fs::file_time_type::clock::now() + std::chrono::hours(2);
  for (const char* name : {"spoolwatch-3-00000.lcmlog", "spoolwatch-3-00001.lcmlog"}) {
    std::ofstream(folder_ / name) << "of another run, before the clock was set back";
    fs::last_write_time(folder_ / name, later);
  }
  Recorder recorder(config_, kRun, false);
  int i = 0;
  for (; logs_in(folder_).size() < 4U; ++i) record(recorder, i);
  const fs::path second = logs_in(folder_)[1];  // of this run: written before the next
  for (const auto& file : logs_in(folder_)) {
    // As if the clock had been set back after the first of them.
    if (file.filename().string().find("-3-") == std::string::npos) {
      fs::last_write_time(file, later + std::chrono::hours(i++));
    }
  }
  for (const auto end = i + 100; i < end; ++i) record(recorder, i);
  recorder.finish();
  const auto files = logs_in(folder_);
  ASSERT_EQ(files.size(), 4U);
  for (const auto& file : files) {
    EXPECT_EQ(file.filename().string().find("-3-"), std::string::npos) << file;
  }
}

TEST_F(RecorderTest, CountsWhatAFullQueueDropsAndWritesTheRest) {
  config_.queue_bytes = 4096;
  RecorderStatus status;
  {
    Recorder recorder(config_, kRun, true);
    for (int i = 0; i < 2000; ++i) record(recorder, i);
    status = recorder.status();
  }
  EXPECT_GT(status.dropped_records, 0);
  const auto events = read_events(logs_in(folder_)[0]);
  EXPECT_EQ(static_cast<std::int64_t>(events.size()), 2000 - status.dropped_records);
  expect_whole(logs_in(folder_)[0]);
}

// A disk of its own, small and really full.
class FullDiskTest : public RecorderTest {
 protected:
  void SetUp() override {
    if (::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=64k") != 0) {
      GTEST_SKIP() << "cannot mount a small tmpfs: " << std::strerror(errno);
    }
    mounted_ = true;
  }
  void TearDown() override {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  void fill(std::size_t leave) {
    const int file = ::open((folder_ / "ballast").c_str(), O_CREAT | O_WRONLY, 0600);
    const std::string block(4096, 'x');
    while (::write(file, block.data(), block.size()) > 0) {
    }
    const auto size = static_cast<off_t>(fs::file_size(folder_ / "ballast") - leave);
    ASSERT_EQ(::ftruncate(file, size), 0);
    ::close(file);
  }
  void free_space() { fs::remove(folder_ / "ballast"); }

  bool mounted_ = false;
};

TEST_F(FullDiskTest, KeepsTheNewestInMemoryAndWritesItWhenSpaceReturns) {
  config_.backlog_bytes = 8192;
  {
    Recorder recorder(config_, kRun, false);
    for (int i = 0; i < 10; ++i) record(recorder, i);
    fill(4096);
    int i = 10;
    for (; i < 100'000 && !recorder.status().disk_full; ++i) record(recorder, i);
    ASSERT_TRUE(recorder.status().disk_full);
    EXPECT_EQ(recorder.status().error, ENOSPC);
    EXPECT_EQ(recorder.status().lost_records, 0);
    expect_whole(logs_in(folder_)[1]);
    for (const int end = i + 1000; i < end; ++i) record(recorder, i);
    const RecorderStatus full = recorder.status();
    EXPECT_TRUE(full.disk_full);
    EXPECT_GT(full.lost_records, 800);
    free_space();
    const int returned = i;
    for (; i < returned + 250; ++i) record(recorder, i);
    const RecorderStatus after = recorder.status();
    EXPECT_FALSE(after.disk_full);
    EXPECT_EQ(after.written_records + after.lost_records, i);
    const auto events = read_events(logs_in(folder_)[0]);
    expect_whole(logs_in(folder_)[0]);
    ASSERT_EQ(static_cast<std::int64_t>(events.size()), after.written_records);
    // One hole, and it is as large as what was counted as lost.
    std::vector<int> holes;
    for (std::size_t k = 1; k < events.size(); ++k) {
      const int step = number_of(events[k]) - number_of(events[k - 1]);
      if (step != 1) holes.push_back(step - 1);
    }
    ASSERT_EQ(holes.size(), 1U);
    EXPECT_EQ(holes[0], after.lost_records);
    EXPECT_EQ(number_of(events.back()), i - 1);
  }
}

TEST_F(FullDiskTest, StartsOnAFullDiskInTheBackgroundAndRecordsOnceThereIsSpace) {
  fill(0);
  Recorder recorder(config_, kRun, true);
  for (int i = 0; i < 100; ++i) record(recorder, i);
  EXPECT_TRUE(wait_for([&] { return recorder.status().disk_full; }));
  free_space();
  EXPECT_TRUE(wait_for([&] { return recorder.status().written_records == 100; }));
  EXPECT_TRUE(wait_for([&] { return !recorder.status().disk_full; }));
  EXPECT_EQ(recorder.status().lost_records, 0);
}

TEST_F(RecorderTest, TakesAFileSizeLimitOfTheProcessForAFullDisk) {
  Recorder recorder(config_, kRun, true);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{2000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  for (int i = 0; i < 100; ++i) record(recorder, i);
  const bool full = wait_for([&] { return recorder.status().disk_full; });
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(full);
  expect_whole(logs_in(folder_)[0]);
  EXPECT_TRUE(wait_for([&] { return recorder.status().written_records == 100; }));
  expect_whole(logs_in(folder_)[0]);
}

TEST_F(RecorderTest, GoesOnInANewFileWhenItsFolderIsRemoved) {
  config_.folder = folder_ / "log";
  Recorder recorder(config_, kRun, false);
  for (int i = 0; i < 10; ++i) record(recorder, i);
  fs::remove_all(config_.folder);
  for (int i = 10; i < 30; ++i) record(recorder, i);
  EXPECT_EQ(recorder.status().removed_records, 10);
  EXPECT_EQ(recorder.finish(), 10) << "what was in the removed log is on no disk";
  ASSERT_EQ(logs_in(config_.folder).size(), 1U);
  const auto events = read_events(logs_in(config_.folder)[0]);
  ASSERT_EQ(events.size(), 20U);
  EXPECT_EQ(number_of(events.front()), 10);
  expect_whole(logs_in(config_.folder)[0]);
}

TEST_F(RecorderTest, TellsInTheEndHowManyMessagesAreNotOnDisk) {
  config_.backlog_bytes = 4096;
  Recorder recorder(config_, kRun, false);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{2000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  for (int i = 0; i < 100; ++i) record(recorder, i);
  const std::int64_t missing = recorder.finish();
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(missing, 100 - static_cast<std::int64_t>(read_events(logs_in(folder_)[0]).size()));
  EXPECT_GT(recorder.status().lost_records, 0) << "some of them left memory too";
}

TEST_F(RecorderTest, SaysInOneLineThatItCannotRecordInAFolder) {
  std::ofstream(folder_ / "file") << "in the way";
  config_.folder = folder_ / "file" / "log";
  try {
    const Recorder recorder(config_, kRun, false);
    FAIL() << "no error";
  } catch (const config::schema::ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), config_.folder + ": cannot record here: Not a directory");
  }
}

}  // namespace
}  // namespace monitor::io
