// Public measured records (SPOOLWATCH_DATA, or shared/data beside the sources); skipped where they
// are not. What is known of them: EMPS has dry friction of some 20 N and an offset of some 3 N
// (Janot et al. 2019); FASTER a null offset.
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/workbench/diagnose/servo_bench.h"

namespace workbench::diagnose {
namespace {

using nlohmann::json;
using testing::Contains;

std::string data(const std::string& name) {
  const char* given = std::getenv("SPOOLWATCH_DATA");
  const std::filesystem::path folder =
      given != nullptr ? given : SPOOLWATCH_SOURCE_DIR "/../shared/data";
  return folder / name;
}

class MeasuredRecord : public testing::Test, public ServoBench {
 protected:
  json diagnosed(const std::string& model, const std::string& name,
                 std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{SPOOLWATCH_SOURCE_DIR "/config/models/" + model, data(name),
                                       "--json", file("d.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(diagnose_with(arguments), 0);
    return json_of(file("d.json"));
  }
};

TEST_F(MeasuredRecord, EmpsHasFrictionAndAnOffset) {
  const std::string name = "emps/train_200Hz.csv";
  if (!std::filesystem::exists(data(name))) GTEST_SKIP() << data(name) << " is not there";
  const json j = diagnosed("force_driven_axis.toml", name);
  const auto missing = j["missing"].get<std::vector<std::string>>();
  EXPECT_THAT(missing, Contains("friction"));
  EXPECT_GT(j["free_run_before_m"].get<double>(), 0.09);
  EXPECT_LE(j["free_run_after_m"].get<double>(), 0.003);
}

TEST_F(MeasuredRecord, FasterHasANullOffset) {
  const std::string name = "faster/faster.csv";
  if (!std::filesystem::exists(data(name))) GTEST_SKIP() << data(name) << " is not there";
  const json j = diagnosed("velocity_servo.toml", name, {"--fit", "first-half"});
  EXPECT_EQ(j["missing"][0], "null_bias");
}

}  // namespace
}  // namespace workbench::diagnose
