// Public measured records (SPOOLWATCH_DATA, or shared/data beside the sources); skipped where they
// are not. What is known of them: EMPS has dry friction of some 20 N and an offset of some 3 N
// (Janot et al. 2019); FASTER a null offset.
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/workbench/diagnose/servo_bench.h"

namespace workbench::diagnose {
namespace {

using nlohmann::json;
using testing::AnyOf;
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
    std::vector<std::string> arguments{program_model(model), data(name), "--json", file("d.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(diagnose_with(arguments), 0);
    return json_of(file("d.json"));
  }
  [[nodiscard]] static std::string program_model(const std::string& name) {
    return SPOOLWATCH_SOURCE_DIR "/config/models/" + name;
  }
  json compared(const std::string& model, const std::string& name,
                const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{model, data(name), "--json", file("c.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(workbench_test::run_command(workbench::cli::add_compare, arguments), 0);
    testing::internal::GetCapturedStdout();
    return json_of(file("c.json"));
  }
};

TEST_F(MeasuredRecord, EmpsHasFrictionAndAnOffset) {
  const std::string name = "emps/train_200Hz.csv";
  if (!std::filesystem::exists(data(name))) GTEST_SKIP() << data(name) << " is not there";
  const json j = diagnosed("force_driven_axis.toml", name, {"-o", file("better.toml")});
  const auto missing = j["missing"].get<std::vector<std::string>>();
  EXPECT_THAT(missing, Contains("friction"));
  // one equation on this plant: gain (u + offset), or the force against it
  EXPECT_THAT(missing, Contains(AnyOf("null_bias", "load_force")));
  EXPECT_FALSE(j["parameters"].contains("friction.direction_ratio"));
  EXPECT_GT(compared(program_model("force_driven_axis.toml"), name)["free_run_rms_m"], 0.09);
  EXPECT_LE(compared(file("better.toml"), name)["free_run_rms_m"], 0.003);
}

TEST_F(MeasuredRecord, FasterHasANullOffset) {
  const std::string name = "faster/faster.csv";
  if (!std::filesystem::exists(data(name))) GTEST_SKIP() << data(name) << " is not there";
  const json j =
      diagnosed("velocity_servo.toml", name, {"--fit", "first-half", "-o", file("better.toml")});
  ASSERT_FALSE(j["missing"].empty());
  EXPECT_EQ(j["missing"][0], "null_bias");
  const config::record::Record record = config::record::read_record(data(name));
  const std::string half = std::to_string(record.t_s[record.size() / 2]);
  EXPECT_LE(compared(file("better.toml"), name, {"--from", half})["free_run_rms_m"], 0.45e-3);
}

}  // namespace
}  // namespace workbench::diagnose
