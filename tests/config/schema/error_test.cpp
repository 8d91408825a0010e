// One line per error, short whatever it is about.
#include "config/schema/error.h"

#include <gmock/gmock.h>

namespace config::schema {
namespace {

using testing::EndsWith;
using testing::StartsWith;

TEST(ErrorLine, IsOneLine) {
  EXPECT_EQ(error_line("a.toml:1", "is\n\x01 wrong", "more"),
            "a.toml:1: is ? wrong; allowed: more");
}

TEST(ErrorLine, KeepsBeginningAndEndOfAKeyThatIsVeryLong) {
  const std::string line =
      error_line("a.toml:9: [" + std::string(100'000, 'k') + "] rate_Hz", "is unknown", "");
  EXPECT_LT(line.size(), 1100U);
  EXPECT_THAT(line, StartsWith("a.toml:9: [kkk"));
  EXPECT_THAT(line, EndsWith("kkk] rate_Hz: is unknown"));
}

TEST(ErrorLine, CutsBytesThatAreNoTextToo) {
  const std::string line = error_line("a", std::string(2000, '\x80'), "");
  EXPECT_EQ(line.size(), 3 + 700 + 3 + 197U);
}

TEST(ErrorLine, CutsAllowedValuesToo) {
  EXPECT_LT(error_line("a", "is unknown", std::string(100'000, 'k')).size(), 4100U);
}

TEST(ErrorLine, CutsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += "\u00e4";
  for (const std::string& shifted : {text, "x" + text}) {
    const std::string line = error_line("a", shifted, "");
    const std::size_t cut = line.find("...");
    ASSERT_NE(cut, std::string::npos);
    EXPECT_EQ(line[cut - 1], '\xa4');
    EXPECT_EQ(line[cut + 3], '\xc3');
  }
}

}  // namespace
}  // namespace config::schema
