// Runs with several outputs, one of which cannot be written: the others are there, and one line
// says which is not.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Outputs : public testing::Test {
 protected:
  Outputs() {
    const Result made = spoolwatch("simulate " + model_ + " -o " + record_ +
                                   " --duration 20 --seed 3 --set instruments.noise_m=2e-6");
    EXPECT_EQ(made.exit_code, 0) << made.out;
  }

  const Folder folder_;
  const std::string model_ = shipped("models/velocity_servo.toml");
  const std::string record_ = folder_.path() / "record.csv";
};

constexpr const char* kFull = "/dev/full: cannot be written: No space left on device\n";

TEST_F(Outputs, OfARunAreWrittenButForTheOneThatCannotBe) {
  const std::string inputs = " " + model_ + " " + record_;
  for (const std::string& command :
       {"fit" + inputs + " --quiet -o", "fit" + inputs + " --report",
        "diagnose" + inputs + " --quiet -o", "diagnose" + inputs + " --quiet --report",
        "compare" + inputs + " --report",
        "isolate" + inputs + " --parameters gain_mps_per_V --report"}) {
    SCOPED_TRACE(command);
    const std::string json = folder_.path() / "answer.json";
    const Result result = spoolwatch(command + " /dev/full --json " + json);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr(std::string("spoolwatch: ") + kFull));
    std::ifstream file(json);
    EXPECT_TRUE(nlohmann::json::accept(file));
    fs::remove(json);
  }
}

TEST_F(Outputs, OfAFitAreShownWhereItsModelCannotBeWritten) {
  const Result result = spoolwatch("fit " + model_ + " " + record_ + " --quiet -o /dev/full");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("gain_mps_per_V"));
  EXPECT_THAT(result.out, HasSubstr(kFull));
}

}  // namespace
}  // namespace program
