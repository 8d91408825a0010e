// Completion and man pages against what the programs say of themselves.
#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  char bytes[512];
  while (std::size_t n = std::fread(bytes, 1, sizeof bytes, pipe)) text.append(bytes, n);
  pclose(pipe);
  return text;
}

/// The words that bash offers behind this line; a space at its end begins a new word.
std::set<std::string> offered(const std::string& line) {
  std::istringstream in(line);
  std::string words;
  int count = 0;
  for (std::string word; in >> word; ++count) words += "'" + word + "' ";
  if (line.back() == ' ') {
    words += "''";
    ++count;
  }
  std::string function = line.substr(0, line.find(' '));
  for (char& c : function) c = c == '-' ? '_' : c;
  const std::string script = "source " SPOOLWATCH_PAGES_DIR "/completion; COMP_WORDS=(" + words +
                             "); COMP_CWORD=" + std::to_string(count - 1) + "; _" + function +
                             "; printf \"%s\\n\" \"${COMPREPLY[@]}\"";
  std::istringstream out(output_of("bash -c \"" + [&] {
    std::string quoted;
    for (const char c : script)
      quoted += (c == '"' || c == '\\' || c == '$' ? "\\" : "") + std::string(1, c);
    return quoted;
  }() + "\""));
  std::set<std::string> result;
  for (std::string word; out >> word;) result.insert(word);
  return result;
}

/// First words of the lines under that heading of --help.
std::set<std::string> listed(const std::string& program, const std::string& heading) {
  std::istringstream lines(output_of(SPOOLWATCH_BIN_DIR "/" + program + " --help"));
  std::set<std::string> words;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == heading + ":") {
      inside = true;
    } else if (inside && line.size() > 2 && line.starts_with("  ") && line[2] != ' ') {
      words.insert(line.substr(2, line.find_first_of(" ,", 2) - 2));
    } else if (inside && !line.starts_with("  ")) {
      inside = false;
    }
  }
  return words;
}

std::string page(const std::string& name) {
  std::ifstream in(SPOOLWATCH_PAGES_DIR "/" + name);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = 0; (at = text.find("\\-", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

TEST(Completion, OffersEveryCommand) {
  const std::set<std::string> commands = listed("spoolwatch", "Subcommands");
  ASSERT_GT(commands.size(), 15U);
  EXPECT_EQ(offered("spoolwatch "), commands);
  EXPECT_THAT(offered("spoolwatch di"), ElementsAre("diagnose", "disarm"));
}

TEST(Completion, OffersTheOptionsOfTheCommandAndTheirValues) {
  EXPECT_THAT(offered("spoolwatch diagnose m.toml --h"), ElementsAre("--help", "--holdout"));
  EXPECT_THAT(offered("spoolwatch estimate r.csv --method "), Contains("recursive"));
  EXPECT_THAT(offered("spoolwatchd --clock "), ElementsAre("realtime", "virtual"));
  EXPECT_THAT(offered("spoolwatchd --"), IsSupersetOf({"--config", "--check", "--null"}));
  EXPECT_THAT(offered("spoolwatch-rig "), ElementsAre("set"));
}

TEST(Completion, LeavesFilesToTheShell) {
  EXPECT_THAT(offered("spoolwatchd --config "), IsEmpty());
  EXPECT_THAT(offered("spoolwatch compare "), IsEmpty());
}

TEST(ManPage, HasEveryCommandAndOption) {
  const std::string tool = page("spoolwatch.1");
  for (const std::string& command : listed("spoolwatch", "Subcommands")) {
    EXPECT_THAT(tool, HasSubstr("\n.SS " + command)) << command;
  }
  for (const std::string& option : listed("spoolwatchd", "Options")) {
    EXPECT_THAT(page("spoolwatchd.8"), HasSubstr("\\fB" + option)) << option;
  }
  EXPECT_THAT(page("spoolwatchd.8"), HasSubstr(".SH EXIT STATUS"));
}

TEST(ManPage, IsUnderstoodByManWithoutAWarning) {
  for (const char* name : {"spoolwatch.1", "spoolwatchd.8", "spoolwatch-rig.1"}) {
    EXPECT_EQ(
        output_of(std::string("command -v groff >/dev/null || exit 0; groff -man -Tutf8 -ww -b "
                              "-z " SPOOLWATCH_PAGES_DIR "/") +
                  name + " 2>&1"),
        "");
  }
}

}  // namespace
