// Which backend reads and which one drives is a matter of configuration alone.
#include "hal/rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace hal {
namespace {

const std::filesystem::path kFolder = SPOOLWATCH_SOURCE_DIR "/config";

void read(Rig& rig, const std::string& text) {
  config::schema::Document::parse("schema_version = 1\n" + text, "rig.toml")
      .read([&](config::schema::Visitor& v) { rig.visit(v); });
}

std::string refusal(const std::string& text) {
  try {
    Rig rig;
    read(rig, text);
    (void)rig.open({"rig.toml", kFolder, 0.005, 0.0});
  } catch (const config::schema::ConfigError& e) {
    return e.what();
  }
  return "accepted";
}

const std::string kSim = "[sim]\nmodel = \"models/thesis.toml\"\n";

TEST(Rig, OpensOneSimulatedRigForBothSides) {
  Rig rig;
  read(rig, "[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"sim\"\n" + kSim);
  const Devices devices = rig.open({"rig.toml", kFolder, 0.005, 0.0});
  ASSERT_NE(devices.rod, nullptr);
  ASSERT_NE(devices.valve, nullptr);
  devices.valve->write(2.0, {});
  EXPECT_NEAR(devices.rod->read({0, 0}).command_V, 2.0, 0.005) << "two rigs instead of one";
  EXPECT_TRUE(std::isnan(devices.sample_time_s));
  EXPECT_TRUE(rig.harmless());
}

TEST(Rig, WithoutAValveDrivesNothing) {
  Rig rig;
  read(rig, "[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"none\"\n" + kSim);
  EXPECT_EQ(rig.open({"rig.toml", kFolder, 0.005, 0.0}).valve, nullptr);
}

TEST(Rig, RefusesTwoInputsOfOneId) {
  const std::string input = "[[input]]\nid = \"a\"\nbackend = \"sim\"\nchannel = \"e_stop\"\n";
  EXPECT_NE(
      refusal("[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"none\"\n" + input + input + kSim)
          .find("id: is \"a\", and so is that of an earlier one"),
      std::string::npos);
}

TEST(Rig, RefusesWhatDoesNotExistOrDoesNotFit) {
  EXPECT_EQ(refusal("[rod]\nbackend = \"modbas\"\n[valve]\nbackend = \"none\"\n"),
            "rig.toml: [rod] backend: is \"modbas\"; allowed: " + backend_names());
  EXPECT_NE(refusal("[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"x\"\n" + kSim)
                .find("[valve] backend: is \"x\"; allowed: " + backend_names() + ", none"),
            std::string::npos);
  EXPECT_NE(refusal("[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"sim\"\n[sim]\n")
                .find("[sim] model: is missing"),
            std::string::npos);
  EXPECT_NE(refusal("[rod]\nbackend = \"sim\"\n[sim]\nmodel = \"no/such.toml\"\n")
                .find("[sim] model: is \""),
            std::string::npos);
}

TEST(Rig, RefusesAPeriodThatIsNoWholeNumberOfIntegrationSteps) {
  Rig rig;
  read(rig, "[rod]\nbackend = \"sim\"\n" + kSim);
  EXPECT_NO_THROW((void)rig.open({"rig.toml", kFolder, 0.004, 0.0}));
  EXPECT_THROW((void)rig.open({"rig.toml", kFolder, 0.0045, 0.0}), config::schema::Error);
}

TEST(Rig, WorstSpeedIsThatOfTheOrificeEquationAtTheLimit) {
  Rig rig;
  read(rig, "[rod]\nbackend = \"sim\"\n[valve]\nbackend = \"sim\"\nlimit_V = 2.0\n" + kSim);
  // Steady: v = Cd w Kv u sqrt((Ps - d v / A) / rho) / A, solved by iteration (model as printed).
  double v_mps = 0.0;
  for (int i = 0; i < 50; ++i) {
    v_mps = 0.6 * 2.07e-2 * 2.79e-5 * 2.0 * std::sqrt((6.89e6 - 1000.0 * v_mps / 6.33e-4) / 847.0) /
            6.33e-4;
  }
  // The column of oil rings: a lightly damped step overshoots by less than its own height.
  const double worst_mps = rig.worst_speed_mps({"rig.toml", kFolder, 0.005, 0.0});
  EXPECT_GE(worst_mps, v_mps * 0.999);
  EXPECT_LE(worst_mps, v_mps * 2.0);
}

}  // namespace
}  // namespace hal
