// A file of whole lines on a disk that does not take them.
#include "daemon/io/capped_file.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <iterator>

#include "tests/daemon/program/subprocess.h"
#include "tests/file_size_limit.h"

namespace {

std::atomic<bool> files_shrink{true};

}  // namespace

/// In place of the library's, for this program.
extern "C" int ftruncate(int file, off_t size) noexcept {
  if (files_shrink) return static_cast<int>(syscall(SYS_ftruncate, file, size));
  errno = EIO;
  return -1;
}

namespace monitor::io {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(CappedFile, CutsATornLineBeforeItIsWrittenAgain) {
  const program::Folder folder;
  const std::filesystem::path path = folder.path() / "lines.log";
  CappedFile file(path, 1 << 20);
  ASSERT_TRUE(file.try_append("first\n"));
  files_shrink = false;
  {
    const tests::FileSizeLimit limit(9);
    EXPECT_FALSE(file.try_append("second\n"));
  }
  files_shrink = true;
  ASSERT_EQ(content(path), "first\nsec") << "neither whole nor removed";
  EXPECT_TRUE(file.try_append("second\n"));
  EXPECT_EQ(content(path), "first\nsecond\n");
}

TEST(CappedFile, HasRoomForWhatKeepsItsLimit) {
  const program::Folder folder;
  CappedFile file(folder.path() / "lines.log", 10);
  EXPECT_EQ(file.room_bytes(6), 10U);
  ASSERT_TRUE(file.try_append("first\n"));
  EXPECT_EQ(file.room_bytes(4), 4U);
  EXPECT_EQ(file.room_bytes(5), 10U) << "in a new file";
}

}  // namespace
}  // namespace monitor::io
