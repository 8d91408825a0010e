// The generator is only worth something while it shares nothing with the product.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

namespace truth {
namespace {

namespace fs = std::filesystem;

TEST(TruthGenerator, IncludesNothingOfTheProductAndNoLibraryOfThirdParties) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  int files = 0;
  for (const auto& entry : fs::directory_iterator(SPOOLWATCH_SOURCE_DIR "/tests/truth")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    ++files;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line)) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      const std::string header = match[1];
      const bool own = header.rfind("tests/truth/", 0) == 0;
      const bool test = header.rfind("gtest/", 0) == 0 || header.rfind("gmock/", 0) == 0;
      const bool standard = header.find_first_of("/.") == std::string::npos;
      EXPECT_TRUE(own || test || standard) << entry.path() << " includes " << header;
    }
  }
  EXPECT_GT(files, 10);
}

TEST(TruthGenerator, LinksNoLibraryOfTheProduct) {
  std::ifstream in(SPOOLWATCH_SOURCE_DIR "/tests/truth/CMakeLists.txt");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  static const std::regex libs(R"(LIBS ([^)\n]*))");
  int lists = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), libs); it != std::sregex_iterator();
       ++it) {
    ++lists;
    const std::string list = (*it)[1];
    EXPECT_TRUE(list == "truth" || list == "Threads::Threads") << list;
  }
  EXPECT_EQ(lists, 3);
}

}  // namespace
}  // namespace truth
