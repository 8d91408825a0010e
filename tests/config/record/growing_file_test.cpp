// Files that are written piece by piece: what has its name is whole, what was cut off stays.
#include "config/record/growing_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "config/schema/error.h"
#include "tests/file_size_limit.h"

namespace config::record {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Growing : public testing::Test {
 protected:
  Growing() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Growing() override { fs::remove_all(folder_); }

  static std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string refusal(const std::function<void()>& work) {
    try {
      work();
    } catch (const schema::RunError& error) {
      return error.what();
    }
    return "accepted";
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("growing_" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "r.csv";
  const fs::path part_ = folder_ / "r.csv.part";
};

TEST_F(Growing, IsRefusedWhereAPipeThatNobodyReadsIsInTheWay) {
  ASSERT_EQ(::mkfifo(part_.c_str(), 0600), 0);
  EXPECT_THAT(refusal([&] { GrowingFile growing(file_); }), HasSubstr("cannot be written"));
}

TEST_F(Growing, HasItsNameAndThePermissionsOfTheOneBeforeOnceItIsWhole) {
  write(file_, "before");
  fs::permissions(file_, fs::perms(0640));
  {
    GrowingFile growing(file_);
    growing.append(std::string(5000, 'a'));
    EXPECT_EQ(text_of(file_), "before");
    EXPECT_EQ(fs::file_size(part_), 5000U);
    EXPECT_EQ(fs::status(part_).permissions() & fs::perms(0077), fs::perms::none);
    growing.append("end\n");
    growing.finish();
  }
  EXPECT_EQ(text_of(file_), std::string(5000, 'a') + "end\n");
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms(0640));
  EXPECT_FALSE(fs::exists(part_));
}

TEST_F(Growing, IsLeftWhereItWasCutOffAndNotWrittenOver) {
  for (const char* text : {"first", "second"}) {
    GrowingFile growing(file_);
    growing.append(text);
  }
  EXPECT_EQ(text_of(folder_ / "r.csv.part1"), "first");
  EXPECT_EQ(text_of(part_), "second");
  {
    GrowingFile growing(file_);
    EXPECT_EQ(growing.kept(), folder_ / "r.csv.part2");
    growing.discard();
  }
  EXPECT_EQ(text_of(folder_ / "r.csv.part2"), "second");
  EXPECT_FALSE(fs::exists(part_));
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(Growing, IsOneProcessesAtATime) {
  GrowingFile growing(file_);
  growing.append("ours");
  EXPECT_EQ(refusal([&] { const GrowingFile another(file_); }),
            part_.string() + ": another process writes it; allowed: another file");
  growing.finish();
  EXPECT_EQ(text_of(file_), "ours");
}

TEST_F(Growing, HoldsNoHalfOfATextOnAFullDisk) {
  write(file_, "before");
  const std::string line = std::string(2999, 'x') + "\n";
  const tests::FileSizeLimit full(8000);
  GrowingFile growing(file_);
  growing.append(line);
  growing.append(line);
  growing.append(line);
  EXPECT_EQ(refusal([&] { growing.append(line); }),
            file_.string() + ": cannot be written: File too large; what came before stands in " +
                part_.string());
  EXPECT_EQ(fs::file_size(part_), 6000U);
  EXPECT_EQ(text_of(file_), "before");
}

TEST_F(Growing, LeavesADeviceAPipeAndALinkInTheirPlace) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  GrowingFile growing(pipe);
  growing.append("through");
  growing.finish();
  char bytes[16]{};
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), 7);
  close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));

  fs::create_symlink("/dev/full", folder_ / "full");
  GrowingFile full(folder_ / "full");
  full.append("x");
  EXPECT_THAT(refusal([&] { full.finish(); }), HasSubstr("full: cannot be written: No space left"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "full"));

  fs::create_symlink(file_, folder_ / "link.csv");
  GrowingFile linked(folder_ / "link.csv");
  linked.append("behind");
  linked.finish();
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.csv"));
  EXPECT_EQ(text_of(file_), "behind");
}

}  // namespace
}  // namespace config::record
