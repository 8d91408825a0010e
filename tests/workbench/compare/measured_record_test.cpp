// Figures on real records, against what was found for them elsewhere and against sums made here.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "config/record/record.h"
#include "workbench/compare/comparison_report.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

std::filesystem::path data(const std::string& name) {
  if (const char* folder = std::getenv("SPOOLWATCH_DATA")) {
    return std::filesystem::path(folder) / name;
  }
  return std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "../shared/data" / name;
}

plant_sim::ModelFile model(const std::string& name) {
  return plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" + name +
                               ".toml");
}

#define SKIP_WITHOUT(file)            \
  if (!std::filesystem::exists(file)) \
  GTEST_SKIP() << (file) << " is not there (set SPOOLWATCH_DATA)"

TEST(MeasuredRecord, OfTheFatigueRigDriftsAsTheReferenceSays) {
  SKIP_WITHOUT(data("faster/faster.csv"));
  const greybox::Dataset whole =
      greybox::dataset_of(config::record::read_record(data("faster/faster.csv")));
  const greybox::Dataset half = greybox::part(whole, 0, whole.size() / 2);
  // v = k u by least squares on the free run: y(k) - y(0) = k Ts sum u.
  double moved = 0.0;
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t k = 0; k < half.size(); ++k) {
    xy += moved * (half.y_m[k] - half.y_m[0]);
    xx += moved * moved;
    moved += half.sample_time_s * half.u_V[k];
  }
  plant_sim::ModelFile servo = model("velocity_servo");
  *servo.value("gain_mps_per_V") = xy / xx;
  *servo.value("time_constant_s") = 0.0;
  const validation::Comparison c = validation::compare(servo, half);
  EXPECT_NEAR(1e3 * c.free_run_rms_m, 2.25, 0.05);
  EXPECT_GT(c.floor_ratio(), 10.0);
}

TEST(MeasuredRecord, OfTheLinearAxisLeavesAtLeastTheReferenceErrorToAViscousModel) {
  SKIP_WITHOUT(data("emps/train_200Hz.csv"));
  plant_sim::ModelFile axis = model("force_driven_axis");
  *axis.value("mass_kg") = 95.11;
  *axis.value("damping_N_s_per_m") = 203.5;
  *axis.value("gain_N_per_V") = 35.15065;
  const greybox::Dataset record =
      greybox::dataset_of(config::record::read_record(data("emps/train_200Hz.csv")));
  const validation::Comparison plain = validation::compare(axis, record);
  EXPECT_GT(1e3 * plain.free_run_rms_m, 90.0);
  EXPECT_EQ(words(plain).judgement, Judgement::fails_throughout);
  // With the published friction and offset the free run stays within a centimetre.
  *axis.value("friction.coulomb_N") = 20.39;
  *axis.value("load_force.force_N") = -3.165;
  const validation::Comparison better = validation::compare(axis, record);
  EXPECT_LT(1e3 * better.free_run_rms_m, 10.0);
}

TEST(MeasuredRecord, WithHiddenFrictionOrBacklashFailsWhileReversing) {
  for (const char* name : {"hidden/case01.csv", "hidden/case06.csv"}) {
    SKIP_WITHOUT(data(name));
    const validation::Comparison c = validation::compare(
        model("thesis"), greybox::dataset_of(config::record::read_record(data(name))));
    ASSERT_TRUE(c.headline.significant) << name;
    EXPECT_EQ(c.headline.ranges.front().name, "reversing") << name;
    EXPECT_GT(c.headline.figures.local_velocity_error_share, 0.8) << name;
  }
}

TEST(MeasuredRecord, WithAnEffectThatGrowsWithSpeedFailsAtHighSpeed) {
  for (const char* name : {"hidden/case07.csv", "hidden/case13.csv"}) {
    SKIP_WITHOUT(data(name));
    const validation::Comparison c = validation::compare(
        model("thesis"), greybox::dataset_of(config::record::read_record(data(name))));
    ASSERT_TRUE(c.headline.significant) << name;
    EXPECT_EQ(c.worst.front().ranges.front().variable, "speed") << name;
    EXPECT_TRUE(c.worst.front().ranges.front().highest) << name;
  }
}

TEST(MeasuredRecord, WithANullBiasIsOffByItsConstantSpeed) {
  SKIP_WITHOUT(data("hidden/case04.csv"));
  const validation::Comparison c = validation::compare(
      model("thesis"), greybox::dataset_of(config::record::read_record(data("hidden/case04.csv"))));
  EXPECT_EQ(c.systematic.cause, validation::ErrorCause::offset);
  EXPECT_LT(c.systematic.offset_mps, 0.0);  // a bias of -0.07 V
  EXPECT_GT(c.systematic.share, 0.98);
}

}  // namespace
}  // namespace workbench::compare
