// The command as people and scripts call it.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/workbench/simulate/program.h"

namespace workbench::reproduce {
namespace {

using simulate::Outcome;
using simulate::run_program;
using simulate::TemporaryFolder;
using testing::HasSubstr;

TEST(ReproduceProgram, WritesATableAndJsonWithTheDocumentedFields) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program("reproduce --json " + folder.file("rows.json"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("agrees"));
  EXPECT_THAT(outcome.output, HasSubstr("Case I:"));
  std::ifstream file(folder.file("rows.json"));
  const auto json = nlohmann::json::parse(file);
  ASSERT_GT(json.at("rows").size(), 80U);
  int yes = 0;
  for (const auto& row : json.at("rows")) {
    EXPECT_TRUE(row.at("what").is_string());
    for (const char* value : {"printed", "ours"}) {
      EXPECT_TRUE(row.at(value).is_number() || row.at(value).is_string() || row.at(value).is_null())
          << row;
    }
    EXPECT_THAT(row.at("agrees").get<std::string>(), testing::AnyOf("yes", "no", "n.a."));
    EXPECT_TRUE(row.at("note").is_string());
    EXPECT_NE(row.at("tolerance"), "");
    yes += row.at("agrees") == "yes" ? 1 : 0;
  }
  EXPECT_GT(yes, 40);
}

TEST(ReproduceProgram, StrictRunEndsWellAndDashPrintsJsonOnly) {
  const Outcome outcome = run_program("reproduce --strict --json -");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(nlohmann::json::accept(outcome.output));
}

TEST(ReproduceProgram, RefusesAFileInAFolderThatIsMissingBeforeItRuns) {
  const Outcome outcome = run_program("reproduce --json /nowhere/rows.json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.error,
            "spoolwatch: --json /nowhere/rows.json: the folder /nowhere does not exist\n");
}

TEST(ReproduceProgram, RefusesAnUnknownOption) {
  EXPECT_EQ(run_program("reproduce --fast").exit_code, 2);
}

}  // namespace
}  // namespace workbench::reproduce
