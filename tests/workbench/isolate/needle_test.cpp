// The needle valve of the thesis's stand, open against 80 % closed, where dry friction is there as
// well: the model is calibrated on a healthy record, and then tracked. The truth has the LuGre law.
//
// Friction needs a start with a bristle (presliding_stiffness_N_per_m above 0): 0 is rigid contact,
// from which no small step leads away.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/truth/case.h"
#include "tests/workbench/run_command.h"

namespace {

using nlohmann::json;
using testing::IsEmpty;
using workbench_test::printed_by;
namespace fs = std::filesystem;

constexpr const char* kNeedle = "coupled_slaves.needle_N_s2_per_m2";
constexpr double kOpen_N_s2_per_m2 = 20.0;
constexpr double kClosed_N_s2_per_m2 = 500.0;  // a fifth of the area: 25 times the pressure drop
/// One window, its stride, and another that confirms.
constexpr double kOnTime_s = 3.0;

/// The slaves as config/models/rig_2000psi_slaves.toml assumes them; the instruments of the rig.
truth::Case stand(const std::string& friction, double length_s, std::size_t seed) {
  truth::Case of = truth::parse_case("motion=sine,plant=printed," + friction, seed);
  of.length_s = length_s;
  of.plant.supply_pressure_Pa = 13.79e6;
  of.plant.valve_gain_m_per_V = 1.14011e-5;
  of.kp_V_per_m = 600.0;
  of.encoder_m = 2.5e-6;
  of.noise_m = 0.2e-6;
  of.hidden.slaves_kg = 20.0;
  of.hidden.slaves_N_s_per_m = 2000.0;
  of.hidden.needle_N_s2_per_m2 = kOpen_N_s2_per_m2;
  return of;
}

class Needle : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("needle_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
               std::to_string(std::hash<std::string>{}(
                   testing::UnitTest::GetInstance()->current_test_info()->name())));
    fs::create_directories(folder_);
    // A minute: in half of it noise can hold the open needle at its bound, 0, where it has no
    // error.
    truth::write_csv(truth::simulate(stand(GetParam(), 60.0, 11)), file("healthy.csv"));
    printed_by(workbench::cli::add_fit,
               {std::string(SPOOLWATCH_SOURCE_DIR "/config/models/rig_2000psi_slaves.toml"),
                file("healthy.csv"), "-o", file("calibrated.toml"), "--quiet", "--profile", "none",
                "--starts", "2", "--set", "effects.friction.presliding_stiffness_N_per_m=3e6",
                "--set", "effects.friction.presliding_damping_N_s_per_m=300", "--set",
                "effects.friction.static_N=320", "--set", "effects.friction.stribeck_mps=0.02",
                "--json", file("fit.json")});
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] json isolated(const truth::Case& of) const {
    truth::write_csv(truth::simulate(of), file("record.csv"));
    printed_by(workbench::cli::add_isolate,
               {file("calibrated.toml"), file("record.csv"), "--parameters",
                std::string("supply_pressure_Pa,") + kNeedle, "--json", file("out.json")});
    return json::parse(std::ifstream(file("out.json")));
  }

  fs::path folder_;
};

TEST_P(Needle, IsToldClosedByFourFifthsWithDryFriction) {
  truth::Case of = stand(GetParam(), 40.0, 1);
  of.changes.push_back({20.0, nullptr, &truth::Hidden::needle_N_s2_per_m2, kClosed_N_s2_per_m2});
  const json found = isolated(of);
  ASSERT_EQ(found["alarms"].size(), 1u) << found["alarms"].dump(1);
  const json& alarm = found["alarms"][0];
  EXPECT_EQ(alarm["parameter"], kNeedle);
  EXPECT_EQ(alarm["direction"], "high");
  EXPECT_GT(alarm["raised_s"], 20.0);
  EXPECT_LT(alarm["raised_s"], 20.0 + kOnTime_s);
  // Slow friction and the needle share a little: the change is surer than the value.
  const double change = alarm["value"].get<double>() - alarm["healthy"].get<double>();
  EXPECT_NEAR(change, kClosed_N_s2_per_m2 - kOpen_N_s2_per_m2, 100.0);
}

TEST_P(Needle, IsNotNamedWhileNothingChangesOrThePressureDoes) {
  EXPECT_THAT(isolated(stand(GetParam(), 40.0, 2))["alarms"], IsEmpty());
  truth::Case of = stand(GetParam(), 40.0, 3);
  of.changes.push_back(
      {20.0, &truth::Plant::supply_pressure_Pa, nullptr, 0.9 * of.plant.supply_pressure_Pa});
  const json found = isolated(of);
  ASSERT_EQ(found["alarms"].size(), 1u) << found["alarms"].dump(1);
  EXPECT_EQ(found["alarms"][0]["parameter"], "supply_pressure_Pa");
}

INSTANTIATE_TEST_SUITE_P(DryFriction, Needle,
                         testing::Values("friction.coulomb_N=300,friction.static_N=300",
                                         "friction.coulomb_N=300,friction.static_N=380,"
                                         "friction.stribeck_mps=0.01"));

}  // namespace
