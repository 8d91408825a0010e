#include "daemon/control/calibration.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "config/schema/error.h"

namespace monitor::control {
namespace {

class CalibrationTest : public testing::Test {
 protected:
  CalibrationTest()
      : file_(std::filesystem::temp_directory_path() /
              ("calibration-" + std::to_string(getpid()) + ".toml")) {}
  ~CalibrationTest() override { std::filesystem::remove(file_); }

  void write(const std::string& text) const { std::ofstream(file_) << text; }
  static Calibration example() {
    Calibration calibration;
    calibration.rig_id = "stand-1";
    calibration.date = "2026-03-01";
    calibration.valve_sign = -1;
    calibration.null_V = 0.31;
    calibration.dead_zone_V = 0.04;
    calibration.rod_scale = 1.002;
    calibration.noise_m = 2e-6;
    calibration.latency_s = 0.004;
    calibration.gain_mps_per_V = 0.045;
    calibration.wiring = "0123456789abcdef";
    calibration.home = "stop_above";
    calibration.home_m = 0.612;
    calibration.authority_V = 0.5;
    calibration.max_travel_m = 0.005;
    calibration.max_speed_mps = 0.05;
    return calibration;
  }
  [[nodiscard]] std::string refusal(const std::string& rig_id) const {
    try {
      (void)load_calibration(file_, rig_id);
    } catch (const config::schema::ConfigError& e) {
      return e.what();
    }
    return "accepted";
  }

  std::filesystem::path file_;
};

TEST_F(CalibrationTest, ComesBackFromItsFileAsItWas) {
  write(print_calibration(example()));
  const Calibration calibration = load_calibration(file_, "stand-1");
  EXPECT_EQ(calibration.valve_sign, -1);
  EXPECT_EQ(calibration.null_V, 0.31);
  EXPECT_EQ(calibration.dead_zone_V, 0.04);
  EXPECT_EQ(calibration.rod_sign, 1);
  EXPECT_EQ(calibration.rod_scale, 1.002);
  EXPECT_EQ(calibration.noise_m, 2e-6);
  EXPECT_EQ(calibration.latency_s, 0.004);
  EXPECT_EQ(calibration.date, "2026-03-01");
  EXPECT_EQ(calibration.gain_mps_per_V, 0.045);
  EXPECT_EQ(calibration.wiring, "0123456789abcdef");
  EXPECT_EQ(calibration.home, "stop_above");
  EXPECT_EQ(calibration.home_m, 0.612);
  EXPECT_EQ(calibration.authority_V, 0.5);
  EXPECT_EQ(calibration.max_travel_m, 0.005);
  EXPECT_EQ(calibration.max_speed_mps, 0.05);
}

TEST_F(CalibrationTest, OfAnotherRigLayoutOrSignIsRefused) {
  write(print_calibration(example()));
  EXPECT_THAT(refusal("stand-2"), testing::HasSubstr("is \"stand-1\"; allowed: \"stand-2\""));
  std::string text = print_calibration(example());
  text.replace(text.find("schema_version = 1"), 18, "schema_version = 2");
  write(text);
  EXPECT_THAT(refusal("stand-1"), testing::HasSubstr("schema_version"));
  Calibration unsigned_valve = example();
  unsigned_valve.valve_sign = 0;
  write(print_calibration(unsigned_valve));
  EXPECT_THAT(refusal("stand-1"), testing::HasSubstr("[valve] sign: is 0"));
  write("schema_version = 1\nrig_id = \"stand-1\"\n");
  EXPECT_THAT(refusal("stand-1"), testing::HasSubstr("is missing"));
}

TEST(Contradiction, IsNoneWhereSignsScaleNullAndWiringFit) {
  Calibration calibration;
  calibration.null_V = 0.3;
  calibration.dead_zone_V = 0.2;
  calibration.wiring = "a";
  // Within half the dead zone and 1 % of 10 V: 0.1 to 0.5 V.
  for (const double null_V : {0.11, 0.3, 0.49}) {
    EXPECT_EQ(contradiction(calibration, null_V, 10.0, "a"), "");
  }
  calibration.wiring = "";
  EXPECT_EQ(contradiction(calibration, 0.3, 10.0, "a"), "") << "nothing is said of the wiring";
}

TEST(Contradiction, IsSaidInOneLine) {
  Calibration fits;
  fits.null_V = 0.3;
  fits.wiring = "a";
  const auto said = [](const Calibration& calibration, double null_V = 0.3) {
    return contradiction(calibration, null_V, 10.0, "a");
  };
  EXPECT_THAT(said(fits, 0.19), testing::HasSubstr("null_V is 0.19; the rod stands still at 0.3"));
  EXPECT_THAT(said(fits, 0.41), testing::HasSubstr("null_V is 0.41"));
  Calibration other = fits;
  other.valve_sign = -1;
  EXPECT_THAT(said(other), testing::HasSubstr("the valve is reversed"));
  other = fits;
  other.rod_sign = -1;
  EXPECT_THAT(said(other), testing::HasSubstr("the rod sensor is reversed"));
  other = fits;
  other.rod_scale = 1.02;
  EXPECT_THAT(said(other), testing::HasSubstr("1 m of reading is 1.02 m"));
  other = fits;
  other.wiring = "b";
  EXPECT_THAT(said(other), testing::HasSubstr("has changed since"));
}

}  // namespace
}  // namespace monitor::control
