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
    calibration.rod_scale = 5e-6;
    calibration.noise_m = 2e-6;
    calibration.latency_s = 0.004;
    return calibration;
  }
  [[nodiscard]] std::string refusal(const std::string& rig_id) const {
    try {
      (void)load_calibration(file_, rig_id);
    } catch (const config::schema::Error& e) {
      EXPECT_EQ(e.exit_code(), 78);
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
  EXPECT_EQ(calibration.rod_scale, 5e-6);
  EXPECT_EQ(calibration.noise_m, 2e-6);
  EXPECT_EQ(calibration.latency_s, 0.004);
  EXPECT_EQ(calibration.date, "2026-03-01");
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

}  // namespace
}  // namespace monitor::control
