// What is learnt of a healthy rig: written, read, and refused where it is of something else.
#include "daemon/tracking/healthy_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "tests/daemon/tracking/tracked.h"

namespace {

using namespace tracking_test;
using testing::HasSubstr;
namespace fs = std::filesystem;

class HealthyFiles : public testing::Test {
 protected:
  void SetUp() override {
    choice_ = iso::choose(model_, usual(), "parameters");
    iso::Healthy healthy{2.5e-6, choice_.file};
    healthy.x[1] = std::log(0.9);
    iso::HealthyFile file = iso::healthy_file(model_, choice_, {}, healthy);
    file.rig_id = "stand-1";
    file.sample_time_s = truth::kSample_s;
    std::ofstream(path_) << config::schema::print_toml([&](auto& v) { file.visit(v); });
  }
  void TearDown() override { fs::remove(path_); }

  std::string refusal(const plant_sim::ModelFile& model, const iso::Settings& settings,
                      double sample_time_s, const std::string& rig_id) const {
    try {
      (void)iso::read_healthy(path_, model, settings, choice_, sample_time_s, rig_id);
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(error.exit_code(), 78);
      return error.what();
    }
    return {};
  }

  plant_sim::ModelFile model_ = printed_model();
  iso::Choice choice_;
  fs::path path_ =
      fs::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".toml");
};

TEST_F(HealthyFiles, ComeBackAsTheyWere) {
  const auto file = iso::read_healthy(path_, model_, {}, choice_, truth::kSample_s, "stand-1");
  const iso::Healthy healthy = iso::healthy_of(file, choice_);
  EXPECT_EQ(healthy.rms_m, 2.5e-6);
  EXPECT_NEAR(healthy.x[0], 0.0, 1e-12);
  EXPECT_NEAR(healthy.x[1], std::log(0.9), 1e-12);
}

TEST_F(HealthyFiles, AreRefusedForAnotherModelRigWindowOrSampleTime) {
  EXPECT_EQ(refusal(model_, {}, truth::kSample_s, "stand-1"), "");
  EXPECT_EQ(refusal(model_, {}, truth::kSample_s, ""), "");
  EXPECT_THAT(refusal(model_, {}, truth::kSample_s, "stand-2"), HasSubstr("another rig, stand-1"));
  EXPECT_THAT(refusal(model_, {}, 0.01, "stand-1"), HasSubstr("sample_time_s"));
  iso::Settings longer;
  longer.window_s = 3.0;
  EXPECT_THAT(refusal(model_, longer, truth::kSample_s, "stand-1"), HasSubstr("another model"));
  plant_sim::ModelFile other = model_;
  *other.value("mass_kg") = 51.0;
  EXPECT_THAT(refusal(other, {}, truth::kSample_s, "stand-1"), HasSubstr("another model"));
}

}  // namespace
