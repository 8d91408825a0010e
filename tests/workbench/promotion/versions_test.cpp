#include "workbench/promotion/versions.h"

#include <gtest/gtest.h>

#include <fstream>

#include "config/schema/error.h"
#include "tests/daemon/program/subprocess.h"

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
  promotion::bring_back({a, b}, promotion::newest_version({a, b}));
  EXPECT_EQ(promotion::read_whole(a), "a1");
  EXPECT_EQ(promotion::read_whole(b), "b1");
  EXPECT_EQ(promotion::read_whole(a.string() + ".withdrawn"), "a2");
  promotion::bring_back({a, b}, promotion::newest_version({a, b}));
  EXPECT_EQ(promotion::read_whole(a), "a0");
  EXPECT_EQ(promotion::newest_version({a, b}), 0);
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

}  // namespace
}  // namespace workbench::promotion
