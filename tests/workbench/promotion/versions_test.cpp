#include "workbench/promotion/versions.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>

#include "config/schema/error.h"
#include "tests/daemon/program/subprocess.h"

namespace {

/// Folders, and files, that may still be synced before every further one fails; negative: all may.
std::atomic<int> folders_that_sync{-1};
std::atomic<int> files_that_sync{-1};

}  // namespace

/// In place of the library's, for this program.
extern "C" int fsync(int file) {
  struct stat found {};
  const bool folder = fstat(file, &found) == 0 && S_ISDIR(found.st_mode);
  std::atomic<int>& left = folder ? folders_that_sync : files_that_sync;
  if (left >= 0 && left-- <= 0) {
    left = 0;
    errno = EIO;
    return -1;
  }
  return static_cast<int>(syscall(SYS_fsync, file));
}

namespace workbench::promotion {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

TEST(Versions, AreKeptAndBroughtBackOneAfterTheOther) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  const fs::path b = folder.path() / "b.toml";
  write(a, "a0");
  write(b, "b0");
  EXPECT_EQ(promotion::newest_version({a, b}), 0);
  EXPECT_EQ(promotion::replace({{a, "a1"}, {b, "b1"}}), 1);
  EXPECT_EQ(promotion::replace({{a, "a2"}, {b, "b2"}}), 2);
  EXPECT_EQ(promotion::read_whole(a), "a2");
  EXPECT_EQ(promotion::read_whole(promotion::version_of(b, 1)), "b0");
  const auto go_back = [&] {
    const int version = promotion::newest_version({a, b});
    promotion::bring_back({a, b}, version);
    promotion::use_up({a, b}, version);
  };
  go_back();
  EXPECT_EQ(promotion::read_whole(a), "a1");
  EXPECT_EQ(promotion::read_whole(b), "b1");
  EXPECT_EQ(promotion::read_whole(a.string() + ".withdrawn"), "a2");
  go_back();
  EXPECT_EQ(promotion::read_whole(a), "a0");
  EXPECT_EQ(promotion::newest_version({a, b}), 0);
}

TEST(Versions, AreTheNewestTwenty) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  const fs::path b = folder.path() / "b.toml";
  write(a, "a0");
  write(b, "b0");
  // as an earlier release left them, and other files
  for (int version = 1; version <= 120; ++version) write(promotion::version_of(a, version), "old");
  for (int version = 1; version <= 118; version += 3)
    write(promotion::version_of(b, version), "old");
  for (const char* other : {"a.toml.v", "a.toml.v7x", "a.toml.withdrawn", "aa.toml.v1"}) {
    write(folder.path() / other, "another");
  }
  const auto kept = [&](const fs::path& file) {
    int count = 0;
    for (int version = 1; version < 1000; ++version) {
      count += fs::exists(promotion::version_of(file, version)) ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(promotion::newest_version({a, b}), 118);
  EXPECT_EQ(promotion::replace({{a, "a1"}, {b, "b1"}}), 121) << "no version is written over";
  EXPECT_EQ(promotion::read_whole(promotion::version_of(a, 121)), "a0");
  EXPECT_EQ(kept(a), promotion::kKeptVersions);
  for (int k = 2; k < 40; ++k) {
    (void)promotion::replace({{a, "a" + std::to_string(k)}, {b, "b" + std::to_string(k)}});
  }
  EXPECT_EQ(kept(a), promotion::kKeptVersions);
  EXPECT_EQ(kept(b), promotion::kKeptVersions);
  EXPECT_EQ(promotion::read_whole(a), "a39");
  EXPECT_EQ(promotion::read_whole(promotion::version_of(a, promotion::newest_version({a, b}))),
            "a38");
  for (const char* other : {"a.toml.v", "a.toml.v7x", "a.toml.withdrawn", "aa.toml.v1"}) {
    EXPECT_TRUE(fs::exists(folder.path() / other)) << other;
  }
}

TEST(Versions, LeaveAllAsItWasWhenOneCannotBeWritten) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  write(a, "a0");
  EXPECT_THROW(promotion::replace({{a, "a1"}, {folder.path() / "none" / "b.toml", "b1"}}),
               config::schema::Error);
  EXPECT_EQ(promotion::read_whole(a), "a0");
  EXPECT_EQ(promotion::newest_version({a}), 0);
}

TEST(Versions, BringBackEveryFileWhenTheFolderIsNotSynced) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  const fs::path b = folder.path() / "b.toml";
  const auto promoted = [&] { return promotion::replace({{a, "a1"}, {b, "b1"}}); };
  // two versions are kept and two files are replaced, each with its folder
  constexpr int kSyncs = 4;
  for (int synced = 0; synced < kSyncs; ++synced) {
    SCOPED_TRACE(synced);
    write(a, "a0");
    write(b, "b0");
    folders_that_sync = synced;
    EXPECT_THROW(promoted(), config::schema::RunError);
    folders_that_sync = -1;
    EXPECT_EQ(promotion::read_whole(a), "a0");
    EXPECT_EQ(promotion::read_whole(b), "b0");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2)
        << "no version and no part of a file is left";
  }
  folders_that_sync = kSyncs;
  EXPECT_EQ(promoted(), 1);
  folders_that_sync = -1;
  EXPECT_EQ(promotion::read_whole(b), "b1");
}

// Model and bands of different versions would keep the daemon from starting again.
TEST(Versions, StayTogetherWhereNothingCanBeWrittenAnyMore) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  const fs::path b = folder.path() / "b.toml";
  // two copies and two files; from one of them on, nothing is written
  for (int synced = 0; synced < 4; ++synced) {
    SCOPED_TRACE(synced);
    write(a, "a0");
    write(b, "b0");
    files_that_sync = synced;
    EXPECT_THROW(promotion::replace({{a, "a1"}, {b, "b1"}}), config::schema::RunError);
    EXPECT_EQ(promotion::read_whole(a), "a0");
    EXPECT_EQ(promotion::read_whole(b), "b0");
    files_that_sync = -1;
    ASSERT_EQ(promotion::replace({{a, "a1"}, {b, "b1"}}), 1);
    files_that_sync = synced;
    EXPECT_THROW(promotion::bring_back({a, b}, 1), config::schema::RunError);
    files_that_sync = -1;
    EXPECT_EQ(promotion::read_whole(a), "a1");
    EXPECT_EQ(promotion::read_whole(b), "b1");
    promotion::use_up({a, b}, 1);
  }
}

TEST(Versions, GoBackTogetherOrNotAtAll) {
  const program::Folder folder;
  const fs::path a = folder.path() / "a.toml";
  const fs::path b = folder.path() / "b.toml";
  write(a, "a0");
  write(b, "b0");
  ASSERT_EQ(promotion::replace({{a, "a1"}, {b, "b1"}}), 1);
  // two files are kept as withdrawn and two are replaced, each with its folder
  constexpr int kSyncs = 4;
  for (int synced = 0; synced < kSyncs; ++synced) {
    SCOPED_TRACE(synced);
    folders_that_sync = synced;
    EXPECT_THROW(promotion::bring_back({a, b}, 1), config::schema::RunError);
    folders_that_sync = -1;
    EXPECT_EQ(promotion::read_whole(a), "a1");
    EXPECT_EQ(promotion::read_whole(b), "b1");
    EXPECT_EQ(promotion::newest_version({a, b}), 1);
  }
  promotion::bring_back({a, b}, 1);
  EXPECT_EQ(promotion::read_whole(a), "a0");
  EXPECT_EQ(promotion::read_whole(b), "b0");
}

}  // namespace
}  // namespace workbench::promotion
