// The baseline of a healthy rig: written, read, and refused where it is of something else.
#include "estimator/fdi/tracker/baseline_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using testing::HasSubstr;
namespace fs = std::filesystem;

class BaselineFiles : public testing::Test {
 protected:
  void SetUp() override {
    set_ = iso::choose(model_, usual(), "parameters");
    iso::Baseline baseline{2.5e-6, set_.file};
    baseline.theta[1] = std::log(0.9);
    baseline.chambers = {{5e3, -2e4, 7e3}, {6e3, 3e4, 8e3}, 1.4e4};
    tracker::BaselineFile file = tracker::baseline_file(model_, set_, {}, baseline);
    file.rig_id = "stand-1";
    file.sample_time_s = truth::kSample_s;
    std::ofstream(path_) << config::schema::print_toml([&](auto& v) { file.visit(v); });
  }
  void TearDown() override { fs::remove(path_); }

  void rewrite(const std::string& from, const std::string& to) const {
    std::ifstream in(path_);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    in.close();
    ASSERT_NE(text.find(from), std::string::npos) << text;
    std::ofstream(path_) << text.replace(text.find(from), from.size(), to);
  }

  /// One line; "" when it is not refused.
  std::string refusal(const plant_sim::ModelFile& model, const iso::TrackerSettings& settings,
                      double sample_time_s, const std::string& rig_id) const {
    try {
      (void)tracker::read_baseline(path_, model, settings, set_, sample_time_s, rig_id);
    } catch (const config::schema::ConfigError& error) {
      std::string line = error.what();
      EXPECT_THAT(line, HasSubstr(path_.string()));
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      return line;
    }
    return {};
  }
  std::string refusal() const { return refusal(model_, {}, truth::kSample_s, "stand-1"); }

  plant_sim::ModelFile model_ = printed_model();
  iso::ParameterSet set_;
  fs::path path_ =
      fs::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".toml");
};

TEST_F(BaselineFiles, ComeBackAsTheyWere) {
  const auto file = tracker::read_baseline(path_, model_, {}, set_, truth::kSample_s, "stand-1");
  const iso::Baseline baseline = tracker::baseline_of(file, set_);
  EXPECT_EQ(baseline.rms_m, 2.5e-6);
  EXPECT_NEAR(baseline.theta[0], 0.0, 1e-12);
  EXPECT_NEAR(baseline.theta[1], std::log(0.9), 1e-12);
  EXPECT_EQ(baseline.chambers.in.rms_Pa, 5e3);
  EXPECT_EQ(baseline.chambers.in.offset_Pa, -2e4);
  EXPECT_EQ(baseline.chambers.out.rms_Pa, 6e3);
  EXPECT_EQ(baseline.chambers.out.offset_Pa, 3e4);
  EXPECT_EQ(baseline.chambers.in.weight_Pa, 7e3);
  EXPECT_EQ(baseline.chambers.out.weight_Pa, 8e3);
  EXPECT_EQ(baseline.chambers.offset_sd_Pa, 1.4e4);
}

TEST_F(BaselineFiles, OfARigWithoutChamberPressuresGoOnWithoutThem) {
  for (const char* line :
       {"pressure_in_error_Pa = 5000.0\n", "pressure_out_error_Pa = 6000.0\n",
        "pressure_in_weight_Pa = 7000.0\n", "pressure_out_weight_Pa = 8000.0\n",
        "pressure_in_offset_Pa = -20000.0\n", "pressure_out_offset_Pa = 30000.0\n",
        "pressure_offset_sd_Pa = 14000.0\n"}) {
    rewrite(line, "");
  }
  const auto file = tracker::read_baseline(path_, model_, {}, set_, truth::kSample_s, "stand-1");
  const iso::Baseline baseline = tracker::baseline_of(file, set_);
  EXPECT_FALSE(baseline.chambers.known());
  // Values that come with the samples then change nothing.
  truth::Case of = stand(6.0);
  of.pressure_noise_Pa = 5e3;
  const truth::Record record = truth::simulate(of);
  iso::ParameterTracker with(model_, set_, {}, truth::kSample_s, kFloor_m);
  iso::ParameterTracker without(model_, set_, {}, truth::kSample_s, kFloor_m);
  with.take(baseline);
  without.take(baseline);
  int windows = 0;
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    config::signals::Pressures chambers;
    chambers.in_Pa = record.in_Pa[k];
    chambers.out_Pa = record.out_Pa[k];
    const auto a = with.push(record.t_s[k], record.u_V[k], record.y_m[k], k == 0, chambers);
    const auto b = without.push(record.t_s[k], record.u_V[k], record.y_m[k], k == 0);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++windows;
    EXPECT_EQ(a->estimates[0].value, b->estimates[0].value);
    EXPECT_EQ(a->estimates[1].std_error, b->estimates[1].std_error);
    EXPECT_FALSE(a->left_out);
  }
  EXPECT_GT(windows, 5);
}

TEST_F(BaselineFiles, AreRefusedForAnotherRigOrSampleTime) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(refusal(model_, {}, truth::kSample_s, ""), "") << "of any rig";
  EXPECT_THAT(refusal(model_, {}, truth::kSample_s, "stand-2"),
              HasSubstr("rig_id: is of another rig, stand-1; allowed: stand-2"));
  EXPECT_THAT(refusal(model_, {}, 0.01, "stand-1"),
              HasSubstr("sample_time_s: is 0.005 s; allowed: 0.01 s"));
}

TEST_F(BaselineFiles, AreRefusedForAnotherWindowOrObserver) {
  iso::TrackerSettings other;
  other.window_s = 3.0;
  EXPECT_THAT(refusal(model_, other, truth::kSample_s, "stand-1"),
              HasSubstr("window_s: was learned with 2 s; allowed: 3 s"));
  other = {};
  other.observer_per_s = 1.0;
  EXPECT_THAT(refusal(model_, other, truth::kSample_s, "stand-1"),
              HasSubstr("observer_per_s: was learned with 2 1/s; allowed: 1 1/s"));
}

TEST_F(BaselineFiles, AreRefusedForAModelWithAnotherValueOrEffectAndSayWhich) {
  plant_sim::ModelFile other = model_;
  *other.value("mass_kg") = 51.0;
  EXPECT_THAT(refusal(other, {}, truth::kSample_s, "stand-1"),
              testing::AllOf(HasSubstr("mass_kg = 50.0; allowed: "), HasSubstr("mass_kg = 51.0")));
  other = model_;
  other.name = "renamed";
  EXPECT_THAT(refusal(other, {}, truth::kSample_s, "stand-1"), HasSubstr("another model, printed"));
}

TEST_F(BaselineFiles, AreRefusedWhereOtherParametersWereTracked) {
  set_ = iso::choose(model_, {"supply_pressure_Pa"}, "parameters");
  EXPECT_THAT(refusal(), HasSubstr("parameters: was learned while supply_pressure_Pa, "
                                   "damping_N_s_per_m were tracked; allowed: supply_pressure_Pa"));
  set_ = iso::choose(model_, {"damping_N_s_per_m", "supply_pressure_Pa"}, "parameters");
  EXPECT_EQ(refusal(), "") << "the order does not matter";
}

TEST_F(BaselineFiles, AreRefusedInAnotherLayout) {
  rewrite("healthy_version = 2", "healthy_version = 1");
  EXPECT_THAT(refusal(), HasSubstr("healthy_version"));
}

}  // namespace
