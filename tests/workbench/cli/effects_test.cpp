#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <algorithm>

#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "plant_sim/library.h"
#include "tests/workbench/run_command.h"

namespace workbench::cli {
namespace {

using testing::HasSubstr;
using workbench_test::run_command;

std::string output(std::vector<std::string> arguments) {
  return workbench_test::printed_by(workbench::cli::add_effects, std::move(arguments));
}

TEST(Effects, ListsEveryEffectWithEquationSitesPlantsAndRanges) {
  const std::string text = output({});
  for (const auto& effect : plant_sim::effect_library()) {
    EXPECT_THAT(text, HasSubstr(effect.name + "\n  " + effect.equation + "\n  acts on "));
  }
  EXPECT_THAT(
      text,
      HasSubstr("acts on opening; for hydraulic_actuator, hydraulic_cylinder, velocity_servo"));
  EXPECT_THAT(text, HasSubstr("0 to 1e-09 m3/s/Pa, typically 2e-12: leakage past the piston"));
  EXPECT_THAT(text, HasSubstr("0 to 1, typically 0.5: share of the band"));
}

TEST(Effects, ListsOneAloneByEitherOfItsNames) {
  for (const char* name : {"coupled_slaves", "added_load"}) {
    const std::string text = output({name});
    EXPECT_THAT(text, testing::StartsWith("coupled_slaves\n")) << name;
    EXPECT_THAT(text, HasSubstr("needle_N_s2_per_m2")) << name;
    EXPECT_THAT(text, testing::Not(HasSubstr("transport_delay"))) << name;
  }
  try {
    output({"frction"});
    FAIL() << "no refusal";
  } catch (const config::schema::UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean friction?"));
  }
}

TEST(Effects, WritesTheSameAsJson) {
  const auto json = nlohmann::json::parse(output({"--json", "-"}));
  ASSERT_EQ(json["effects"].size(), 26U);
  EXPECT_EQ(json["plants"].size(), 4U);
  for (const auto& effect : json["effects"]) {
    EXPECT_FALSE(effect["equation"].get<std::string>().empty());
    EXPECT_FALSE(effect["plants"].empty()) << effect["name"];
    for (const auto& parameter : effect["parameters"]) {
      const std::string name = parameter["name"];
      EXPECT_EQ(parameter["unit"].get<std::string>().empty(), name.ends_with("_ratio")) << name;
    }
  }
  const auto& effects = json["effects"];
  const auto limit_at = std::find_if(effects.begin(), effects.end(), [](const auto& effect) {
    return effect["name"] == "flow_saturation";
  });
  ASSERT_NE(limit_at, effects.end());
  const auto& limit = *limit_at;
  EXPECT_TRUE(limit["parameters"][0]["neutral"].is_null());  // infinite
  EXPECT_EQ(limit["parameters"][0]["unit"], "m3/s");
}

TEST(Effects, ListsTheFormulasOfAModelFileBehindTheLibrary) {
  const std::string model = SPOOLWATCH_SOURCE_DIR "/config/models/cubic_drag.toml";
  EXPECT_THAT(output({model}),
              HasSubstr("cubic_drag\n  F = drag_N_s3_per_m3 * v_mps^3\n  seals that drag with the "
                        "cube of the speed\n  acts on force; for hydraulic_actuator, "
                        "hydraulic_cylinder, force_driven_axis\n    drag_N_s3_per_m3               "
                        "0 to 1e+07 N s3/m3, "
                        "typically 250000: force per speed cubed\n"));
  const auto json = nlohmann::json::parse(output({model, "--json", "-"}));
  ASSERT_EQ(json["effects"].size(), plant_sim::effect_library().size() + 1);
  EXPECT_EQ(json["effects"].back()["name"], "cubic_drag");
  EXPECT_EQ(json["effects"].back()["sites"][0], "force");
  EXPECT_FALSE(json["effects"].front().contains("what"));
  EXPECT_THROW(output({"/nowhere/model.toml"}), config::schema::Error);
}

TEST(Effects, RefusesAFileThatCannotBeWritten) {
  EXPECT_THROW(run_command(workbench::cli::add_effects, {"--json", "/nowhere/library.json"}),
               config::schema::Error);
}

}  // namespace
}  // namespace workbench::cli
