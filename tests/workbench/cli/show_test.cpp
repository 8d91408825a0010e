#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "tests/workbench/run_command.h"
#include "tests/workbench/simulate/program.h"

namespace workbench::cli {
namespace {

using testing::HasSubstr;
using workbench_test::printed_by;

std::string model(const char* name) {
  return std::string(SPOOLWATCH_SOURCE_DIR "/config/models/") + name + ".toml";
}

std::string written(const std::string& text) {
  const std::string file = workbench::simulate::process_file("spoolwatch_show.toml");
  std::ofstream(file) << "schema_version = 1\n" << text;
  return file;
}

nlohmann::json shown(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "-"});
  return nlohmann::json::parse(printed_by(add_show, std::move(arguments)));
}

double derived(const nlohmann::json& sheet, const std::string& name) {
  for (const auto& one : sheet["derived"]) {
    if (one["name"] == name) return one["value"];
  }
  ADD_FAILURE() << name;
  return 0.0;
}

const nlohmann::json& parameter(const nlohmann::json& sheet, const std::string& name) {
  for (const char* table : {"parameters", "effects"}) {
    for (const auto& one : sheet[table]) {
      if (one["name"] == name) return one;
    }
  }
  ADD_FAILURE() << name;
  return sheet;
}

TEST(Show, SaysWhatIsStatedAndWhatIsDefault) {
  const auto sheet = shown({written(
      "name = \"a\"\nplant = \"force_driven_axis\"\n[parameters]\nmass_kg = 30.0\n[priors]\n"
      "mass_kg = 0.1\n[effects.friction]\ncoulomb_N = 25.0\n")});
  EXPECT_EQ(parameter(sheet, "mass_kg")["source"], "file");
  EXPECT_EQ(parameter(sheet, "mass_kg")["prior_ratio"], 0.1);
  EXPECT_EQ(parameter(sheet, "damping_N_s_per_m")["source"], "default");
  EXPECT_EQ(parameter(sheet, "damping_N_s_per_m")["value"], 200.0);
  EXPECT_EQ(parameter(sheet, "gain_N_per_V")["fitted"], false);
  EXPECT_EQ(parameter(sheet, "friction.coulomb_N")["fitted"], true);
  EXPECT_TRUE(parameter(sheet, "friction.coulomb_N")["prior_ratio"].is_null());
  EXPECT_EQ(parameter(sheet, "friction.static_N")["source"], "neutral");
  EXPECT_THAT(sheet["held"].get<std::string>(),
              HasSubstr("mass_kg, damping_N_s_per_m and friction.coulomb_N"));
}

TEST(Show, DerivesWhatADataSheetStates) {
  const auto axis = shown({model("force_driven_axis")});
  EXPECT_NEAR(derived(axis, "steady_speed_positive_mps"), 350.0 / 200.0, 1e-3);
  EXPECT_NEAR(derived(axis, "time_constant_s"), 0.5, 1e-12);
  EXPECT_NEAR(derived(axis, "full_acceleration_m_per_s2"), 3.5, 1e-12);
  const auto servo = shown({model("velocity_servo")});
  EXPECT_NEAR(derived(servo, "steady_speed_negative_mps"), -0.5, 1e-6);
  EXPECT_NEAR(derived(servo, "bandwidth_Hz"), 15.915, 1e-3);
  // Butterworth: the -3 dB frequency is the natural one
  const auto second = shown({model("velocity_servo"), "--set",
                             fmt::format("parameters.damping_ratio={}", std::sqrt(0.5))});
  EXPECT_NEAR(derived(second, "bandwidth_Hz"), 15.915, 1e-3);
  // the same by the inertia of a lag of 10 ms: 1 / (2 pi 0.01 sqrt(0.5))
  const auto inert =
      shown({model("velocity_servo"), "--set", "effects.second_order_lag.inertia_ratio=0.5"});
  EXPECT_NEAR(derived(inert, "bandwidth_Hz"), 22.508, 1e-3);
  const auto thesis = shown({model("thesis")});
  // two orifices in series: A v = G x sqrt((Ps - d v/A)/2)
  const double orifice = 0.6 * 2.07e-2 * std::sqrt(2.0 / 847.0) * 2.79e-4;
  const double v = derived(thesis, "steady_speed_positive_mps");
  EXPECT_NEAR(6.33e-4 * v, orifice * std::sqrt(0.5 * (6.89e6 - 1000.0 * v / 6.33e-4)),
              1e-3 * 6.33e-4 * v);
  EXPECT_NEAR(derived(thesis, "stall_force_N"), 6.33e-4 * 6.89e6, 1e-9);
}

TEST(Show, DerivesACylindersSpeedsForcesAndPressuresFromItsTwoAreas) {
  // by hand: A = 1.963e-3, B = 1.159e-3, Ps = 140 bar, Pe = 3 bar, 40 l/min at 35 bar and 10 V;
  // weight 200 kg g sin 0.5 = 940.3 N; the spool's rod side opens 0.6 as far
  const auto sheet = shown({model("single_rod_cylinder"), "--set", "parameters.inclination_rad=0.5",
                            "--set", "parameters.valve_area_ratio=0.6"});
  EXPECT_NEAR(derived(sheet, "cap_over_rod_side"), 1.6937, 1e-4);
  EXPECT_NEAR(derived(sheet, "weight_N"), 940.312, 1e-3);
  EXPECT_NEAR(derived(sheet, "extend_speed_at_rated_flow_mps"), 0.339633, 1e-6);
  EXPECT_NEAR(derived(sheet, "retract_speed_at_rated_flow_mps"), -0.345142, 1e-6);
  // the speed at which both edges' drops leave the weight, by bisection
  EXPECT_NEAR(derived(sheet, "extend_velocity_gain_mps_per_V"), 0.0528967, 1e-7);
  EXPECT_NEAR(derived(sheet, "retract_velocity_gain_mps_per_V"), 0.0420810, 1e-7);
  EXPECT_NEAR(derived(sheet, "extend_stall_force_N"), 27134.3, 1e-6);
  EXPECT_NEAR(derived(sheet, "retract_stall_force_N"), 15637.1, 1e-6);
  // A Pi - B Po = weight, Pi + Po = Ps + Pe
  EXPECT_NEAR(derived(sheet, "cap_rest_pressure_Pa"), 5609869.2, 1.0);
  EXPECT_NEAR(derived(sheet, "rod_rest_pressure_Pa"), 8690130.8, 1.0);
  const double v = derived(sheet, "steady_speed_positive_mps");
  const double edge = 6.667e-4 / std::sqrt(3.5e6);
  const double in_Pa = 140e5 - std::pow(1.963e-3 * v / edge, 2);
  const double out_Pa = 3e5 + std::pow(1.159e-3 * v / (0.6 * edge), 2);
  EXPECT_NEAR(1.963e-3 * in_Pa - 1.159e-3 * out_Pa, 940.312 + 2000.0 * v, 20.0);
  EXPECT_LT(derived(sheet, "steady_speed_negative_mps"), -0.3);
}

TEST(Show, FindsTheSoftestPositionOfACylinder) {
  // the least of beta (A^2/(Vi + A y) + B^2/(Vo + B (L - y))) over half a million positions
  const struct {
    const char *cap_m3, *rod_m3;
    double y_m, N_per_m, Hz, damping;
  } cases[] = {{"2e-4", "2e-4", 0.336054, 9511863.0, 34.70867, 0.0229273},
               {"2e-4", "1.2e-3", 0.5, 5256986.0, 25.80320, 0.0308402},
               {"2e-3", "1e-4", 0.0, 4684262.0, 24.35711, 0.0326712}};
  for (const auto& c : cases) {
    const auto sheet = shown({model("single_rod_cylinder"), "--set",
                              std::string("parameters.cap_dead_volume_m3=") + c.cap_m3, "--set",
                              std::string("parameters.rod_dead_volume_m3=") + c.rod_m3});
    EXPECT_NEAR(derived(sheet, "softest_position_m"), c.y_m, 2e-6);
    EXPECT_NEAR(derived(sheet, "oil_stiffness_N_per_m"), c.N_per_m, 1.0);
    EXPECT_NEAR(derived(sheet, "natural_frequency_Hz"), c.Hz, 1e-5);
    EXPECT_NEAR(derived(sheet, "damping_ratio"), c.damping, 1e-7);
  }
}

TEST(Show, GivesACylindersSpeedsAtTheCommandThatIsRated) {
  const std::string text = printed_by(
      add_show, {model("single_rod_cylinder"), "--set", "parameters.rated_command_V=100"});
  EXPECT_THAT(text, HasSubstr("steady speed at +100 V"));
  EXPECT_THAT(text, HasSubstr("601 mm/s"));
}

TEST(Show, SplitsASecondMassIntoItsParts) {
  const auto sheet =
      shown({model("force_driven_axis"), "--set", "effects.second_mass.mass_ratio=0.36", "--set",
             "effects.second_mass.resonance_Hz=10"});
  EXPECT_NEAR(derived(sheet, "second_mass_kg"), 36.0, 1e-9);
  EXPECT_NEAR(derived(sheet, "second_mass_held_Hz"), 8.0, 1e-9);
  EXPECT_NEAR(derived(sheet, "second_mass_stiffness_N_per_m"), 36.0 * std::pow(2.0 * M_PI * 8.0, 2),
              1e-6);
}

TEST(Show, PrintsARotaryAxisInRadians) {
  const std::string text = printed_by(
      add_show, {written("name = \"a\"\nplant = \"force_driven_axis\"\nmotion = \"rotary\"\n"
                         "[parameters]\nmass_kg = 0.006\ngain_N_per_V = 0.5\n")});
  EXPECT_THAT(text, HasSubstr("0.006 kg m2"));
  EXPECT_THAT(text, HasSubstr("0.5 N m/V"));
  EXPECT_THAT(text, HasSubstr("N m s/rad"));
  EXPECT_THAT(text, HasSubstr("is held at 0.5 N m/V"));
  EXPECT_THAT(text, HasSubstr("torque at +10 V"));
  EXPECT_THAT(text, testing::Not(HasSubstr("mm/s")));
  EXPECT_THAT(printed_by(add_show, {model("force_driven_axis")}), HasSubstr("100 kg "));
}

TEST(Show, ListsChangesAndDerivesFromTheModelBeforeThem) {
  const std::string axis =
      "name = \"a\"\nplant = \"force_driven_axis\"\n[parameters]\nmass_kg = 30.0\n";
  const std::string changes =
      "[[change]]\nparameter = \"mass_kg\"\nvalue = 60.0\nat_s = 2.0\n"
      "[[change]]\nparameter = \"damping_N_s_per_m\"\nfactor = 1.5\nat_s = 4.0\nramp_s = 3.0\n";
  const auto sheet = shown({written(axis + changes)});
  ASSERT_EQ(sheet["changes"].size(), 2U);
  EXPECT_EQ(sheet["changes"][0]["value"], 60.0);
  EXPECT_TRUE(sheet["changes"][1]["value"].is_null());
  EXPECT_EQ(sheet["changes"][1]["ramp_s"], 3.0);
  const std::string text = printed_by(add_show, {written(axis + changes)});
  EXPECT_THAT(text, HasSubstr("to 60 kg at 2 s"));
  EXPECT_THAT(text, HasSubstr("times 1.5 at 4 s, over 3 s"));
  for (const char* plant :
       {"thesis", "single_rod_cylinder", "velocity_servo", "force_driven_axis"}) {
    std::ifstream in(model(plant));
    std::string before{std::istreambuf_iterator<char>(in), {}};
    const std::string file = workbench::simulate::process_file("spoolwatch_show_change.toml");
    const std::string name = plant == std::string("velocity_servo") ? "gain_mps_per_V" : "mass_kg";
    std::ofstream(file) << before << "\n[[change]]\nparameter = \"" << name
                        << "\"\nfactor = 2.0\nat_s = 1.0\n";
    EXPECT_EQ(shown({file})["derived"], shown({model(plant)})["derived"]) << plant;
  }
}

TEST(Show, RefusesARotaryCylinderAndAMissingFile) {
  EXPECT_THROW(printed_by(add_show, {written("name = \"a\"\nplant = \"hydraulic_actuator\"\n"
                                             "motion = \"rotary\"\n")}),
               config::schema::ConfigError);
  EXPECT_THROW(printed_by(add_show, {"/nowhere/model.toml"}), config::schema::Error);
}

}  // namespace
}  // namespace workbench::cli
