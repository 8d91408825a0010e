#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/schema/error.h"
#include "plant_sim/model_file.h"
#include "tests/workbench/run_command.h"
#include "tests/workbench/simulate/program.h"
#include "workbench/model/kinds.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;
using testing::HasSubstr;
using workbench_test::printed_by;

const std::vector<std::string> kCylinder{
    "--bore-mm",    "50",  "--rod-mm",         "32", "--stroke-mm",      "500", "--mass-kg", "200",
    "--supply-bar", "140", "--rated-flow-lpm", "40", "--rated-drop-bar", "70"};

plant_sim::ModelFile made(const std::string& kind, const std::vector<std::string>& flags) {
  const std::string file =
      workbench::simulate::process_file("spoolwatch_new_" + std::string(kind) + ".toml");
  std::filesystem::remove(file);
  std::vector<std::string> arguments{kind, "-o", file};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  printed_by(add_new, arguments);
  return plant_sim::load_model(file);
}

std::string refused(std::vector<std::string> arguments) {
  try {
    printed_by(add_new, std::move(arguments));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

TEST(New, PutsTheRatedFlowIntoADoubleRodCylinder) {
  plant_sim::ModelFile model = made("double-rod", kCylinder);
  EXPECT_NEAR(*model.value("area_m2"), 1.15925e-3, 1e-8);
  EXPECT_EQ(*model.value("stroke_m"), 0.5);
  EXPECT_EQ(*model.value("supply_pressure_Pa"), 1.4e7);
  const double flow = *model.value("discharge_coefficient") * *model.value("area_gradient_m") *
                      10.0 * *model.value("valve_gain_m_per_V") *
                      std::sqrt(2.0 * 35e5 / *model.value("density_kg_per_m3"));
  EXPECT_NEAR(flow, 40.0 / 6e4, 1e-8);
  // -3 dB of the second-order spool at 50 Hz
  const double r = 2.0 * M_PI * 50.0 / *model.value("valve_natural_frequency_rad_per_s");
  EXPECT_NEAR(std::pow(1.0 - r * r, 2) + std::pow(2.0 * 0.8 * r, 2), 2.0, 1e-4);
  EXPECT_EQ(model.uncertainty_ratio(0), 0.1);
}

TEST(New, MakesASingleRodCylinderOfAllThatIsAsked) {
  std::vector<std::string> flags = kCylinder;
  flags.insert(flags.end(),
               {"--return-bar", "3", "--rated-command-V", "8", "--valve-Hz", "25",
                "--valve-damping", "0.9", "--hose-cm3", "120", "--damping-N-s-per-m", "1500",
                "--bulk-MPa", "900", "--inclination-deg", "30", "--valve-area-ratio", "0.5"});
  plant_sim::ModelFile model = made("single-rod", flags);
  EXPECT_EQ(model.plant, "hydraulic_cylinder");
  const std::pair<const char*, double> expected[] = {{"mass_kg", 200.0},
                                                     {"cap_area_m2", 1.963495e-3},  // pi/4 50^2 mm2
                                                     {"rod_side_area_m2", 1.159248e-3},
                                                     {"stroke_m", 0.5},
                                                     {"inclination_rad", 0.5235988},
                                                     {"damping_N_s_per_m", 1500.0},
                                                     {"bulk_modulus_Pa", 9e8},
                                                     {"cap_dead_volume_m3", 1.2e-4},
                                                     {"rod_dead_volume_m3", 1.2e-4},
                                                     {"supply_pressure_Pa", 1.4e7},
                                                     {"return_pressure_Pa", 3e5},
                                                     {"rated_flow_m3ps", 6.666667e-4},
                                                     {"rated_drop_Pa", 3.5e6},  // of one edge
                                                     {"rated_command_V", 8.0},
                                                     {"valve_area_ratio", 0.5},
                                                     {"valve_bandwidth_Hz", 25.0},
                                                     {"valve_damping_ratio", 0.9},
                                                     {"initial.y_m", 0.25}};
  for (const auto& [name, value] : expected) {
    EXPECT_NEAR(*model.value(name), value, 5e-6 * std::abs(value)) << name;
  }
}

TEST(New, ReducesInertiasToTheAxisThatIsMeasured) {
  plant_sim::ModelFile rotary =
      made("rotary-axis", {"--motor-inertia-kgcm2", "2", "--load-inertia-kgcm2", "100", "--gear",
                           "5", "--torque-constant-Nm-per-A", "0.4", "--drive-A-per-V", "1.5"});
  EXPECT_TRUE(rotary.rotary());
  EXPECT_NEAR(*rotary.value("mass_kg"), 6e-4, 1e-9);
  EXPECT_NEAR(*rotary.value("gain_N_per_V"), 0.6, 1e-9);
  plant_sim::ModelFile screw =
      made("screw-axis", {"--mass-kg", "50", "--lead-mm", "10", "--inertia-kgcm2", "5",
                          "--torque-constant-Nm-per-A", "0.5", "--drive-A-per-V", "1"});
  EXPECT_NEAR(*screw.value("mass_kg"), 50.0 + 5e-4 * std::pow(2.0 * M_PI / 0.01, 2), 1e-2);
  EXPECT_NEAR(*screw.value("gain_N_per_V"), 0.5 * 2.0 * M_PI / 0.01, 1e-3);
  plant_sim::ModelFile servo = made("rotary-servo", {"--full-speed-rpm", "3000"});
  EXPECT_NEAR(*servo.value("gain_mps_per_V"), 31.4159, 1e-3);
}

TEST(New, TakesAServosValveByItsBandwidthOrItsStep) {
  for (const std::vector<std::string>& sheet :
       {std::vector<std::string>{"--valve-Hz", "20"}, {"--valve-step-ms", "20"}}) {
    std::vector<std::string> flags{"--full-speed-mmps", "500", "--valve-damping", "0.7"};
    flags.insert(flags.end(), sheet.begin(), sheet.end());
    plant_sim::ModelFile servo = made("velocity-servo", flags);
    const double zeta = *servo.value("damping_ratio");
    EXPECT_EQ(zeta, 0.7);
    const double r = 2.0 * M_PI * 20.0 * *servo.value("time_constant_s");
    EXPECT_NEAR(std::pow(1.0 - r * r, 2) + std::pow(2.0 * zeta * r, 2), 2.0, 1e-4);
  }
  plant_sim::ModelFile lag = made("velocity-servo", {"--full-speed-mmps", "500"});
  EXPECT_EQ(*lag.value("damping_ratio"), 0.0);
  EXPECT_EQ(*lag.value("time_constant_s"), 0.01);
}

TEST(New, ThePriorsOfTheFileAreThoseOfAFit) {
  plant_sim::ModelFile motor = made("linear-motor", {"--mass-kg", "12", "--force-constant-N-per-A",
                                                     "80", "--drive-A-per-V", "0.6"});
  EXPECT_EQ(motor.uncertainty_ratio(0), 0.2);
  EXPECT_EQ(motor.uncertainty_ratio(2), 0.0);  // the gain is held
  const std::string again = plant_sim::print_model(motor);
  EXPECT_THAT(again, HasSubstr("[priors]\nmass_kg = 0.2\n"));
  EXPECT_THAT(plant_sim::print_model(plant_sim::ModelFile()), testing::Not(HasSubstr("priors")));
}

TEST(New, RefusesInOneLineWithTheNearName) {
  EXPECT_THAT(refused({"duble-rod", "-o", "x.toml"}), HasSubstr("did you mean double-rod?"));
  EXPECT_THAT(refused({"rotary-servo", "-o", "x.toml", "--full-speed-rpm", "30", "--bore-mm", "5"}),
              HasSubstr("--bore-mm is not asked of this kind; allowed: --full-speed-rpm"));
  EXPECT_THAT(
      refused({"linear-motor", "-o", "x.toml", "--mass-kg", "3"}),
      testing::AllOf(HasSubstr("lacks --force-constant-N-per-A"), HasSubstr("--drive-A-per-V")));
  EXPECT_THAT(refused({"rotary-servo", "-o", "x.toml", "--full-speed-rpm", "-3"}),
              HasSubstr("--full-speed-rpm is -3, out of range; allowed: 0.001 to"));
  std::vector<std::string> thick{"double-rod", "-o", "x.toml"};
  thick.insert(thick.end(), kCylinder.begin(), kCylinder.end());
  thick[6] = "60";
  EXPECT_THAT(refused(thick), HasSubstr("no rod for --bore-mm 50"));
}

/// The flags of kCylinder with one value replaced, or one added.
std::vector<std::string> cylinder_with(const std::string& kind, const std::string& flag,
                                       const std::string& value) {
  std::vector<std::string> flags{kind, "-o",
                                 workbench::simulate::process_file("spoolwatch_new_no.toml")};
  flags.insert(flags.end(), kCylinder.begin(), kCylinder.end());
  const auto found = std::find(flags.begin(), flags.end(), flag);
  if (found == flags.end()) {
    flags.insert(flags.end(), {flag, value});
  } else {
    *(found + 1) = value;
  }
  return flags;
}

TEST(New, NamesTheOptionItsValueAndItsRange) {
  for (const char* kind : {"double-rod", "single-rod"}) {
    // pi/4 (50^2 - d^2) mm2 = 1 mm2 at d = 49.98726
    EXPECT_THAT(refused(cylinder_with(kind, "--rod-mm", "49.999")),
                testing::AllOf(HasSubstr("--rod-mm (is 49.999; allowed: 1 to 49.98)"),
                               HasSubstr("--bore-mm (is 50; allowed: 50.02 to ")))
        << kind;
    for (const char* text : {"abc", "32,5", "3 2", "", "32mm", "0x20"}) {
      EXPECT_THAT(
          refused(cylinder_with(kind, "--rod-mm", text)),
          HasSubstr(std::string("--rod-mm is \"") + text + "\", no number; allowed: 1 to 990"))
          << kind;
    }
    for (const char* text : {"nan", "inf", "0", "-3", "1e9"}) {
      EXPECT_THAT(
          refused(cylinder_with(kind, "--rod-mm", text)),
          testing::AllOf(HasSubstr("--rod-mm is "), HasSubstr("out of range; allowed: 1 to 990")))
          << kind;
    }
  }
  EXPECT_THAT(
      refused({"velocity-servo", "-o", workbench::simulate::process_file("spoolwatch_new_no.toml"),
               "--full-speed-mmps", "1e5", "--full-command-V", "0.5"}),
      testing::AllOf(HasSubstr("--full-speed-mmps (is 100000; allowed: 0.001 to 50000)"),
                     HasSubstr("--full-command-V (is 0.5; allowed: 1 to 1000)")));
  EXPECT_THAT(
      refused({"screw-axis", "-o", workbench::simulate::process_file("spoolwatch_new_no.toml"),
               "--mass-kg", "0.1", "--lead-mm", "0.1", "--inertia-kgcm2", "1e6",
               "--torque-constant-Nm-per-A", "1", "--drive-A-per-V", "1"}),
      HasSubstr("mass_kg would be 3.948e+11, allowed: 1e-06 to 1e+06; change --lead-mm"));
}

/// Each question of each kind, at either end of its range and beyond, the others in the middle: a
/// file that reads back and whose numbers follow, or a message with the option and its range.
TEST(New, TakesOrRefusesEveryNumberByName) {
  const std::string file = workbench::simulate::process_file("spoolwatch_new_edge.toml");
  for (const model::Kind& kind : model::kinds()) {
    for (const model::Question& asked : kind.questions) {
      for (const double value : {asked.min, asked.max, 2.0 * asked.max, asked.min - 1.0}) {
        std::vector<std::string> arguments{kind.name, "-o", file};
        for (const model::Question& q : kind.questions) {
          if (&q != &asked && !std::isnan(q.usual)) continue;
          const std::string middle = q.flag == "bore-mm" ? "63" : q.flag == "rod-mm" ? "36" : "100";
          arguments.insert(arguments.end(),
                           {"--" + q.flag, &q == &asked ? fmt::format("{}", value) : middle});
        }
        std::filesystem::remove(file);
        const std::string said = refused(arguments);
        EXPECT_EQ(said == "taken", std::filesystem::exists(file))
            << kind.name << asked.flag << said;
        if (said == "taken") continue;
        EXPECT_THAT(said, HasSubstr("--" + asked.flag + " ")) << kind.name;
        EXPECT_THAT(said, HasSubstr("allowed: ")) << kind.name;
      }
    }
  }
}

TEST(New, SaysThatAnUndampedAxisIsNeverSteady) {
  const std::string file = workbench::simulate::process_file("spoolwatch_new_undamped.toml");
  for (const char* drive : {"0.6", "6000"}) {
    std::filesystem::remove(file);
    EXPECT_THAT(printed_by(add_new, {"linear-motor", "-o", file, "--mass-kg", "12",
                                     "--force-constant-N-per-A", "80", "--drive-A-per-V", drive,
                                     "--damping-N-s-per-m", "0"}),
                testing::ContainsRegex("steady speed at .10 V +never steady"));
  }
}

TEST(New, KeepsAFileThatExists) {
  (void)made("rotary-servo", {"--full-speed-rpm", "30"});
  const std::string file = workbench::simulate::process_file("spoolwatch_new_rotary-servo.toml");
  EXPECT_THAT(refused({"rotary-servo", "-o", file, "--full-speed-rpm", "40"}),
              HasSubstr("exists; allowed: a new file"));
  EXPECT_NEAR(*plant_sim::load_model(file).value("gain_mps_per_V"), M_PI / 10.0, 1e-3);
}

TEST(New, RefusesANameThatIsNoPlainText) {
  for (const char* name : {"a\"b", "a\\b", "a\nb"}) {
    EXPECT_THAT(
        refused({"rotary-servo", "-o", workbench::simulate::process_file("spoolwatch_no.toml"),
                 "--name", name, "--full-speed-rpm", "40"}),
        HasSubstr("--name: has a quote"));
  }
}

TEST(New, EveryKindMakesAModelThatReadsBack) {
  for (const model::Kind& kind : model::kinds()) {
    std::vector<std::string> flags;
    for (const model::Question& q : kind.questions) {
      if (!std::isnan(q.usual)) continue;
      flags.push_back("--" + q.flag);
      flags.push_back(q.flag == "bore-mm" ? "63" : q.flag == "rod-mm" ? "36" : "100");
    }
    const plant_sim::ModelFile model = made(kind.name, flags);
    EXPECT_EQ(model.name, "spoolwatch_new_" + kind.name);
  }
}

}  // namespace
}  // namespace workbench::cli
