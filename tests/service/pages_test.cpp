// Completion and man pages against what the programs say of themselves.
#include <gmock/gmock.h>

#include <cstdio>
#include <filesystem>
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
using testing::Not;

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

constexpr const char* kGroups[] = {"Model", "Data", "Detection", "Running stand", "Exchange"};

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

std::set<std::string> commands_of(const std::string& group = "") {
  std::set<std::string> all;
  for (const char* const one : kGroups) {
    if (group.empty() || group == one) all.merge(listed("spoolwatch", one));
  }
  return all;
}

std::string page(const std::string& name) {
  std::ifstream in(SPOOLWATCH_PAGES_DIR "/" + name);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = 0; (at = text.find("\\-", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

TEST(Completion, OffersEveryCommand) {
  std::set<std::string> commands = commands_of();
  ASSERT_GT(commands.size(), 15U);
  commands.insert("help");
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
  EXPECT_THAT(offered("spoolwatch compare m.toml --report "), IsEmpty());
}

TEST(Completion, OffersModelsAndRecordsWhereTheyBelong) {
  const std::filesystem::path before = std::filesystem::current_path();
  const std::filesystem::path folder = testing::TempDir() + "completion";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "runs");
  for (const char* const name : {"m.toml", "r.csv", "r.mat", "log.lcmlog", "notes.txt"}) {
    std::ofstream(folder / name) << "";
  }
  std::filesystem::current_path(folder);
  EXPECT_THAT(offered("spoolwatch compare "), ElementsAre("m.toml", "runs"));
  EXPECT_THAT(offered("spoolwatch compare m.toml "),
              ElementsAre("log.lcmlog", "r.csv", "r.mat", "runs"));
  EXPECT_THAT(offered("spoolwatch diagnose m.toml --quiet r.csv "), Contains("r.mat"));
  EXPECT_THAT(offered("spoolwatch track m.toml r"), ElementsAre("r.csv", "r.mat", "runs"));
  std::filesystem::current_path(before);
}

TEST(Completion, OffersEffectsAndParameters) {
  EXPECT_THAT(offered("spoolwatch add m.toml fric"), ElementsAre("friction"));
  EXPECT_THAT(offered("spoolwatch add m.toml deadband "),
              ElementsAre("ahead_ratio=", "clearance_V=", "corner_V=", "half_width_V="));
  EXPECT_THAT(offered("spoolwatch compare m.toml r.csv --set effects.deadb"),
              ElementsAre("effects.deadband.ahead_ratio=", "effects.deadband.clearance_V=",
                          "effects.deadband.corner_V=", "effects.deadband.half_width_V="));
  EXPECT_THAT(offered("spoolwatch isolate --parameters mass"), ElementsAre("mass_kg"));
}

TEST(ManPage, HasEveryCommandAndOption) {
  const std::string overview = page("spoolwatch.1");
  for (const char* const group : kGroups) {
    const std::string name = std::string(group) == "Running stand" ? "Stand" : group;
    const std::string in_group =
        page("spoolwatch-" + std::string(1, static_cast<char>(std::tolower(name[0]))) +
             name.substr(1) + ".1");
    EXPECT_THAT(in_group, HasSubstr("\n.SH EXAMPLES\n")) << group;
    EXPECT_THAT(commands_of(group), Not(IsEmpty())) << group;
    for (const std::string& command : commands_of(group)) {
      EXPECT_THAT(in_group, HasSubstr("\n.SS " + command)) << command;
      EXPECT_THAT(overview, HasSubstr("\\fB" + command + "\\fR")) << command;
    }
  }
  for (const std::string& option : listed("spoolwatchd", "Options")) {
    EXPECT_THAT(page("spoolwatchd.8"), HasSubstr("\\fB" + option)) << option;
  }
  EXPECT_THAT(page("spoolwatchd.8"), HasSubstr(".SH EXIT STATUS"));
}

TEST(ManPage, IsUnderstoodByManWithoutAWarning) {
  for (const char* name :
       {"spoolwatch.1", "spoolwatch-model.1", "spoolwatch-data.1", "spoolwatch-detection.1",
        "spoolwatch-stand.1", "spoolwatch-exchange.1", "spoolwatch-rig.1", "spoolwatch-model.5",
        "spoolwatch-record.5", "spoolwatchd.8"}) {
    EXPECT_EQ(
        output_of(std::string("command -v groff >/dev/null || exit 0; groff -man -Tutf8 -ww -b "
                              "-z " SPOOLWATCH_PAGES_DIR "/") +
                  name + " 2>&1"),
        "");
  }
}

/// Exit code and the text of standard error.
std::pair<int, std::string> refused(const std::string& arguments,
                                    const std::string& program = "spoolwatch") {
  const std::string text = output_of(SPOOLWATCH_BIN_DIR "/" + program + " " + arguments +
                                     " 2>&1 >/dev/null; echo \"$?\"");
  const std::size_t code = text.rfind('\n', text.size() - 2) + 1;
  return {std::stoi(text.substr(code)), text.substr(0, code)};
}

TEST(Commands, AMistypedCommandNamesTheNearOne) {
  EXPECT_EQ(refused("diagnos m.toml"),
            (std::pair<int, std::string>{
                2, "spoolwatch: command diagnos is unknown, did you mean diagnose?\n"}));
  EXPECT_EQ(refused("trak").second, "spoolwatch: command trak is unknown, did you mean track?\n");
  EXPECT_EQ(refused("xyzzy").second,
            "spoolwatch: command xyzzy is unknown; spoolwatch --help lists all\n");
  EXPECT_EQ(refused("").first, 2);
}

TEST(Commands, AMistypedOptionNamesTheNearOne) {
  EXPECT_EQ(
      refused("diagnose m.toml r.csv --heldout-sp 2"),
      (std::pair<int, std::string>{
          2, "spoolwatch: diagnose: option --heldout-sp is unknown, did you mean --holdout?\n"}));
  EXPECT_EQ(refused("diagnose --heldout-sp 2").second,
            "spoolwatch: diagnose: option --heldout-sp is unknown, did you mean --holdout?\n")
      << "before what else is missing";
  EXPECT_EQ(refused("compare m.toml r.csv --rep=x.html").second,
            "spoolwatch: compare: option --rep is unknown, did you mean --report?\n");
  EXPECT_EQ(refused("fit m.toml r.csv --xyzzyplugh").second,
            "spoolwatch: fit: option --xyzzyplugh is unknown\n");
  EXPECT_EQ(refused("--versoin").second,
            "spoolwatch: option --versoin is unknown, did you mean --version?\n");
  EXPECT_EQ(refused("--chek", "spoolwatchd"),
            (std::pair<int, std::string>{
                2, "spoolwatchd: option --chek is unknown, did you mean --check?\n"}));
  EXPECT_EQ(refused("--lisen x", "spoolwatch-rig"),
            (std::pair<int, std::string>{
                2, "spoolwatch-rig: option --lisen is unknown, did you mean --listen?\n"}));
}

TEST(Commands, SwappedFilesAreNamedWithTheRightOrder) {
  const std::string model = SPOOLWATCH_SOURCE_DIR "/config/models/velocity_servo.toml";
  const std::string record = testing::TempDir() + "swapped.csv";
  std::ofstream(record) << "t_s,u_V,y_m\n0,1,0\n0.1,1,0\n0.2,1,0\n";
  for (const std::string command : {"compare", "fit", "diagnose", "isolate"}) {
    EXPECT_EQ(refused(command + " " + record + " " + model),
              (std::pair<int, std::string>{
                  2, "spoolwatch: " + command + ": MODEL and RECORD are swapped: " + record +
                         " is a record, " + model + " is a TOML file; the order is: spoolwatch " +
                         command + " MODEL RECORD\n"}));
  }
  EXPECT_EQ(refused("estimate " + model).second,
            "spoolwatch: estimate: " + model +
                " is a TOML file, but RECORD must be a record; the order is: spoolwatch estimate "
                "RECORD\n");
  EXPECT_EQ(
      refused("simulate " + record + " -o " + record + ".out").second,
      "spoolwatch: simulate: " + record +
          " is a record, but MODEL must be a TOML file; the order is: spoolwatch simulate MODEL\n");
  EXPECT_THAT(refused("calibrate " + record + " " + model).second,
              HasSubstr("config and RECORD are swapped"))
      << "before what else is missing";
}

TEST(Commands, HelpExplainsACommand) {
  const std::string tool = SPOOLWATCH_BIN_DIR "/spoolwatch ";
  EXPECT_EQ(output_of(tool + "help"), output_of(tool + "--help"));
  EXPECT_EQ(output_of(tool + "help compare"), output_of(tool + "compare --help"));
  EXPECT_THAT(output_of(tool + "help track"), HasSubstr("Usage: spoolwatch isolate"));
  EXPECT_EQ(refused("help diagnos").first, 2);
}

}  // namespace
