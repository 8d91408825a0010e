// Files are written whole, beside the name that they take, and through links.
#include "config/record/whole_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "config/schema/error.h"

namespace config::record {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  WholeFile() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "below");
  }
  ~WholeFile() override { fs::remove_all(folder_); }

  static std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) / ("whole_file_" + std::to_string(getpid()));
};

TEST_F(WholeFile, IsWrittenWhereALinkLeadsAndTheLinkStays) {
  const fs::path target = folder_ / "below" / "model.toml";
  std::ofstream(target) << "before";
  fs::create_symlink("below/model.toml", folder_ / "near.toml");
  fs::create_symlink(target, folder_ / "below" / "whole.toml");
  fs::create_symlink("below/whole.toml", folder_ / "chain.toml");
  int number = 0;
  for (const char* link : {"near.toml", "below/whole.toml", "chain.toml"}) {
    const std::string text = "text " + std::to_string(++number);
    write_whole(folder_ / link, text);
    EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
    EXPECT_EQ(text_of(target), text) << link;
  }
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(target)));
  EXPECT_EQ(files_in(folder_), 3U) << "nothing is left beside the links";
  EXPECT_EQ(files_in(folder_ / "below"), 2U);
}

TEST_F(WholeFile, IsMadeWhereALinkLeadsToNoFileYet) {
  fs::create_symlink("below/new.toml", folder_ / "link.toml");
  write_whole(folder_ / "link.toml", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.toml"));
  EXPECT_EQ(text_of(folder_ / "below" / "new.toml"), "new");
}

TEST_F(WholeFile, IsRefusedWhereALinkLeadsNowhere) {
  fs::create_symlink("none/new.toml", folder_ / "link.toml");
  EXPECT_THROW(write_whole(folder_ / "link.toml", "new"), schema::RunError);
  fs::create_symlink("round.toml", folder_ / "round.toml");
  EXPECT_THROW(write_whole(folder_ / "round.toml", "new"), schema::RunError);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.toml"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "round.toml"));
  EXPECT_EQ(files_in(folder_), 3U);
}

TEST_F(WholeFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  const fs::path file = folder_ / "model.toml";
  using fs::perms;
  const perms shared =
      perms::owner_read | perms::owner_write | perms::group_read | perms::group_write;
  const perms read_only = perms::owner_read | perms::group_read | perms::others_read;
  for (const perms mode : {perms::owner_read | perms::owner_write, shared, read_only}) {
    std::ofstream(file) << "before";
    fs::permissions(file, mode);
    fs::create_symlink(file, folder_ / "link.toml");
    write_whole(file, "text");
    EXPECT_EQ(fs::status(file).permissions(), mode);
    write_whole(folder_ / "link.toml", "through the link");
    EXPECT_EQ(fs::status(file).permissions(), mode);
    EXPECT_EQ(text_of(file), "through the link");
    fs::remove(folder_ / "link.toml");
    fs::remove(file);
  }
}

TEST_F(WholeFile, ADeviceBehindALinkIsWrittenTo) {
  fs::create_symlink("/dev/null", folder_ / "null");
  write_whole(folder_ / "null", "text");
  EXPECT_TRUE(fs::is_symlink(folder_ / "null"));
  EXPECT_TRUE(fs::is_character_file(fs::status("/dev/null")));
}

}  // namespace
}  // namespace config::record
