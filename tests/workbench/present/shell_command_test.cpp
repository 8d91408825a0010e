#include "workbench/present/shell_command.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace workbench::present {
namespace {

/// The word as a shell reads it.
std::string through_shell(const std::string& word) {
  FILE* pipe = popen(("printf %s " + shell_word(word)).c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
  pclose(pipe);
  return out;
}

TEST(ShellWord, ReachesTheProgramAsItWas) {
  for (const std::string word : {"bench.csv", "my bench.csv", "it's $HOME `date`.csv", "a\"b\\c*",
                                 "two\nlines", "--set", "a;b&c|d>e"}) {
    EXPECT_EQ(through_shell(word), word);
  }
  EXPECT_EQ(shell_word("/data/bench-1.csv"), "/data/bench-1.csv");
}

}  // namespace
}  // namespace workbench::present
