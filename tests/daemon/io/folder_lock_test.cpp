// Folders of a daemon: claimed once, refused where they cannot be written.
#include "daemon/io/folder_lock.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "config/schema/error.h"

namespace monitor::io {
namespace {

class FolderLockTest : public testing::Test {
 protected:
  FolderLockTest() {
    std::string name = (std::filesystem::temp_directory_path() / "folder-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~FolderLockTest() override { std::filesystem::remove_all(folder_); }
  static std::string refusal(const std::filesystem::path& folder, int exit_code) {
    try {
      FolderLock lock;
      lock.claim(folder, "rig.toml: [alarms] folder");
    } catch (const config::schema::Error& e) {
      EXPECT_EQ(config::schema::exit_code_of(e), exit_code) << e.what();
      return e.what();
    }
    return "claimed";
  }
  std::filesystem::path folder_;
};

TEST_F(FolderLockTest, IsOneDaemonsUntilItEnds) {
  {
    FolderLock lock;
    lock.claim(folder_ / "log", "a");
    lock.claim(folder_ / "log" / ".." / "log", "b");  // its own
    lock.claim("", "c");
    EXPECT_THAT(refusal(folder_ / "log", 1), testing::HasSubstr("is in use by another daemon"));
    EXPECT_EQ(refusal(folder_ / "other", 1), "claimed");
  }
  EXPECT_EQ(refusal(folder_ / "log", 1), "claimed");
}

TEST_F(FolderLockTest, IsRefusedWhereItCannotBeWritten) {
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_THAT(refusal(folder_ / "file" / "log", 78), testing::HasSubstr("cannot be written: "));
  EXPECT_THAT(refusal("/proc/none/log", 78),
              testing::StartsWith("rig.toml: [alarms] folder: \"/proc/none/log\" cannot be"));
}

}  // namespace
}  // namespace monitor::io
