// Whatever a path leads to: the whole file, or why not.
#include "config/schema/read_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace config::schema {
namespace {

TEST(ReadFile, GivesTheWholeFile) {
  std::string name = (std::filesystem::temp_directory_path() / "read-XXXXXX").string();
  close(mkstemp(name.data()));
  const std::string text(200'000, 'x');
  std::ofstream(name) << text;
  EXPECT_EQ(read_file(name, kMiB).text, text);
  EXPECT_EQ(read_file(name, kMiB).wrong, "");
  EXPECT_EQ(read_file(name, 100'000).wrong, "is larger than 0 MiB");
  EXPECT_EQ(read_file(name, 100'000).text, "");
  std::filesystem::remove(name);
}

TEST(ReadFile, RefusesDevicesFoldersAndReadErrors) {
  EXPECT_EQ(read_file("/dev/zero", kMiB).wrong, "is a device");
  EXPECT_EQ(read_file("/tmp", kMiB).wrong, "is a folder");
  EXPECT_EQ(read_file("/no/such/file", kMiB).wrong, "No such file or directory");
  // Address 0 is never mapped: the kernel answers EIO.
  EXPECT_EQ(read_file("/proc/self/mem", kMiB).wrong, "Input/output error");
}

TEST(ReadFile, ReadsAPipe) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "text", 4), 4);
  close(ends[1]);
  EXPECT_EQ(read_file("/proc/self/fd/" + std::to_string(ends[0]), kMiB).text, "text");
  close(ends[0]);
}

TEST(ReadHead, GivesTheBeginningOfARegularFileAndLeavesEverythingElseUnread) {
  std::string name = (std::filesystem::temp_directory_path() / "head-XXXXXX").string();
  close(mkstemp(name.data()));
  std::ofstream(name) << "beginning and more";
  EXPECT_EQ(read_head(name, 9).text, "beginning");
  EXPECT_EQ(read_head(name, 100).text, "beginning and more");
  std::filesystem::remove(name);
  EXPECT_EQ(read_head("/dev/zero", 4).wrong, "is a device");
  EXPECT_EQ(read_head("/tmp", 4).wrong, "is a folder");
  EXPECT_EQ(read_head("/proc/self/mem", 4).wrong, "Input/output error");
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "text", 4), 4);
  close(ends[1]);
  const std::string of_pipe = "/proc/self/fd/" + std::to_string(ends[0]);
  EXPECT_EQ(read_head(of_pipe, 4).wrong, "is a pipe");
  EXPECT_EQ(read_file(of_pipe, kMiB).text, "text") << "its bytes are still to come";
  close(ends[0]);
}

}  // namespace
}  // namespace config::schema
