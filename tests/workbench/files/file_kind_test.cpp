// The kind of a file, by its beginning.
#include "workbench/files/file_kind.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace workbench::files {
namespace {

FileKind kind_of_text(const std::string& text) {
  std::string name = (std::filesystem::temp_directory_path() / "kind-XXXXXX").string();
  close(mkstemp(name.data()));
  std::ofstream(name) << text;
  const FileKind kind = kind_of(name);
  std::filesystem::remove(name);
  return kind;
}

TEST(FileKind, IsSeenByTheFirstLineThatSaysSomething) {
  EXPECT_EQ(kind_of_text("# a stand\n\nplant = \"axis\"\n"), FileKind::toml);
  EXPECT_EQ(kind_of_text("\n[rig]\nid = 1\n"), FileKind::toml);
  EXPECT_EQ(kind_of_text("t_s,u_V,y_m\n0,1,0\n"), FileKind::record);
  EXPECT_EQ(kind_of_text("Zeit [s];Weg [mm]\n0,0;1,5\n"), FileKind::record);
  EXPECT_EQ(kind_of_text("Time\tPosition\n0\t1\n"), FileKind::record);
  EXPECT_EQ(kind_of_text(std::string("\xFF\xFEt\0,\0", 6)), FileKind::record);
  EXPECT_EQ(kind_of_text(std::string(1 << 20, 'x')), FileKind::other);
  EXPECT_EQ(kind_of("/no/such/file"), FileKind::other);
  // Below comments of any length, a key at whatever place.
  for (const int comments : {100, 146, 147, 148, 900}) {
    std::string text;
    for (int i = 0; i < comments; ++i) text += "# " + std::string(53, 'c') + "\n";
    EXPECT_EQ(kind_of_text(text + "schema_version = 1\n"), FileKind::toml) << comments;
  }
  EXPECT_EQ(kind_of_text("# a note\nt_s,u_V,y_m"), FileKind::record) << "no line end";
  for (const std::size_t bytes : {5'000U, 9'000U, 300'000U}) {
    const std::string comment = "# " + std::string(bytes, 'c') + "\n";
    EXPECT_EQ(kind_of_text(comment + "t_s,u_V,y_m\n0,1,0\n"), FileKind::record) << bytes;
    EXPECT_EQ(kind_of_text(comment + "schema_version = 1\n"), FileKind::toml) << bytes;
  }
}

TEST(FileKind, DevicesAndPipesAreLeftUnread) {
  EXPECT_EQ(kind_of("/dev/zero"), FileKind::other);
  const std::string pipe = testing::TempDir() + "kind_pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(kind_of(pipe), FileKind::other) << "nobody writes to it: to wait is to hang";
  unlink(pipe.c_str());
}

}  // namespace
}  // namespace workbench::files
