#include "config/record/text_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "config/record/readers.h"
#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::TemporaryFile;
using testing::HasSubstr;

/// A window that must go on many times.
constexpr TextWindow::Sizes kSmall{
    .piece_bytes = 100, .most_bytes = 1000, .longest_line_bytes = 300};

std::string table(int rows) {
  std::string text = "t_s,u_V,y_m\n";
  for (int i = 0; i < rows; ++i) {
    text += std::to_string(0.005 * i) + "," + std::to_string(std::sin(i)) + "," +
            std::to_string(0.1 * std::cos(i)) + "\n";
    if (i % 700 == 0) text += "# a comment\n";
  }
  return text;
}

/// The error of reading `file` through `sizes`; empty: none.
std::string error_of(const std::string& file, TextWindow::Sizes sizes) {
  try {
    TextWindow window(file, sizes);
    (void)read_csv(window, file);
    return "";
  } catch (const schema::DataError& error) {
    return error.what();
  }
}

std::string error_of(const std::string& file) {
  try {
    (void)read_record(file);
    return "";
  } catch (const schema::DataError& error) {
    return error.what();
  }
}

TEST(TextWindow, GoesThroughAFileLineByLine) {
  const std::string text = table(500) + "without an end";
  const TemporaryFile file(text);
  TextWindow window(file.path(), kSmall);
  EXPECT_FALSE(window.ends_with_newline());
  std::string found(window.text());
  EXPECT_EQ(window.bytes_from(window.begin()), text.size());
  while (!window.last()) {
    window.refill();
    EXPECT_EQ(window.bytes_from(window.begin()), text.size() - found.size());
    found += window.text();
    EXPECT_TRUE(window.last() || found.back() == '\n');
  }
  EXPECT_EQ(found, text);
}

TEST(TextWindow, ReadsTheSameNumbersThroughASmallWindow) {
  for (const std::string& end : {std::string(), std::string("EOF\n"), std::string(5000, '\n')}) {
    const std::string text = table(3000) + end;
    const TemporaryFile file(text);
    TextWindow small(file.path(), kSmall);
    TextWindow whole(text);
    const Record a = read_csv(small, "a");
    const Record b = read_csv(whole, "a");
    EXPECT_EQ(a.size(), 3000U);
    EXPECT_EQ(a.t_s, b.t_s);
    EXPECT_EQ(a.u_V, b.u_V);
    EXPECT_EQ(a.y_m, b.y_m);
    EXPECT_EQ(a.notes, b.notes);
  }
}

TEST(TextWindow, NamesTheLineOfAnErrorFarBehindTheFirstWindow) {
  const std::string good = table(3000);
  const auto lines = std::to_string(std::count(good.begin(), good.end(), '\n') + 1);
  for (const auto& [bad, words] :
       {std::pair<std::string, std::string>{"15,1\n", "too few fields"},
        {"15,x,1\n", "'x' is no number"},
        {"15,1,0.", "is cut off"},
        {std::string(5000, '\n') + "15,1,1\n", "is an empty line"},
        {"EOF\n" + std::string(5000, '\n') + "15,1,1\n", "is EOF, but rows follow"},
        {"15,1," + std::string(5000, ' ') + "1\n", "is longer than a line may be"},
        {"# " + std::string(5000, ' ') + "\n", "is longer than a line may be"}}) {
    const TemporaryFile file(good + bad);
    EXPECT_THAT(error_of(file.path(), kSmall), HasSubstr(":" + lines + ": "));
    EXPECT_THAT(error_of(file.path(), kSmall), HasSubstr(words));
  }
}

TEST(TextWindow, RefusesALineThatHasNoEnd) {
  const TemporaryFile file(std::string(3'000'000, '1'));
  EXPECT_THAT(error_of(file.path()), HasSubstr(":1: is longer than a line may be"));
}

TEST(TextWindow, RefusesAFileThatBecomesShorterWhileItIsRead) {
  const TemporaryFile file(table(3000));
  TextWindow window(file.path(), kSmall);
  ASSERT_EQ(truncate(file.path().c_str(), 50'000), 0);
  try {
    (void)read_csv(window, "shrinking.csv");
    FAIL() << "read";
  } catch (const schema::DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be read (it became shorter while it was read)"));
  }
}

TEST(TextWindow, LeavesOutWhatIsAppendedWhileTheFileIsRead) {
  const TemporaryFile file(table(3000));
  TextWindow window(file.path(), kSmall);
  std::ofstream(file.path(), std::ios::app) << "15,1\n";
  EXPECT_EQ(read_csv(window, "growing.csv").size(), 3000U);
}

TEST(ReadRecord, RefusesDevicesFoldersAndReadErrorsWithTheirReason) {
  EXPECT_THAT(error_of("/dev/zero"), HasSubstr("/dev/zero: cannot be read (is a device)"));
  EXPECT_THAT(error_of("/tmp"), HasSubstr("/tmp: cannot be read (is a folder)"));
  EXPECT_THAT(error_of("/no/such.csv"), HasSubstr("cannot be read (No such file or directory)"));
  // Reading an address that is not mapped fails with EIO.
  EXPECT_THAT(error_of("/proc/self/mem"), HasSubstr("cannot be read (Input/output error)"));
}

TEST(ReadRecord, ReadsAPipe) {
  const std::string text = table(3000);
  const std::string pipe = testing::TempDir() + "/record_pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << text; });
  EXPECT_EQ(read_record(pipe).size(), 3000U);
  writer.join();
  unlink(pipe.c_str());
}

}  // namespace
}  // namespace config::record
