// Where residuals arise, of residuals that are written down.
#include "workbench/diagnose/residual_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/greybox/observer_simulation.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace {

constexpr double kSampleTime_s = 0.005;
constexpr double kRate = 3.0;  ///< rad/s: a parabola over 100 ms follows it
constexpr double kSize_m = 1e-3;
/// The parabola takes off (rate half window)^2 / 10 of the slope, and some of the curvature.
constexpr double kSmoothing = 0.005;

struct Wave {
  greybox::Dataset record;
  std::vector<double> residual_m;
};

Wave wave() {
  Wave w;
  std::vector<double> y_m;
  for (int k = 0; k < 2000; ++k) {
    w.residual_m.push_back(kSize_m * std::sin(kRate * kSampleTime_s * k));
    y_m.push_back(0.2 + 0.05 * std::sin(kSampleTime_s * k));
  }
  w.record = greybox::dataset_of(kSampleTime_s, y_m, y_m);
  for (int k = 0; k < 100; ++k) w.residual_m[static_cast<std::size_t>(k)] = std::nan("");
  return w;
}

plant_sim::ModelFile model(const std::string& name) {
  return plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/" + name + ".toml");
}

TEST(ResidualSource, OfAForceDrivenAxisIsTheForceThatItLacks) {
  const Wave w = wave();
  plant_sim::ModelFile axis = model("force_driven_axis");
  *axis.value("mass_kg") = 30.0;
  *axis.value("damping_N_s_per_m") = 120.0;
  const ResidualSource source = residual_source(axis, w.record, w.residual_m);
  EXPECT_EQ(source.axis.unit, "N");
  const double l = greybox::kObserver_per_s;
  const double most_N = kSize_m * (30.0 * kRate * (kRate + l) + 120.0 * (kRate + l));
  for (std::size_t k = 200; k < 1900; ++k) {
    const double phase = kRate * kSampleTime_s * static_cast<double>(k);
    const double e = kSize_m * std::sin(phase);
    const double slope = kSize_m * kRate * std::cos(phase);
    const double truth = -(30.0 * (-kRate * kRate * e + l * slope) + 120.0 * (slope + l * e));
    EXPECT_NEAR(source.values[k], truth, kSmoothing * most_N) << k;
  }
  EXPECT_TRUE(std::isnan(source.values[50]));
}

TEST(ResidualSource, OfAServoIsTheSpeedByWhichItIsOff) {
  const Wave w = wave();
  const ResidualSource source = residual_source(model("velocity_servo"), w.record, w.residual_m);
  EXPECT_EQ(source.axis.unit, "mm/s");
  const double l = greybox::kObserver_per_s;
  for (std::size_t k = 200; k < 1900; ++k) {
    const double phase = kRate * kSampleTime_s * static_cast<double>(k);
    const double truth = 1e3 * kSize_m * (kRate * std::cos(phase) + l * std::sin(phase));
    EXPECT_NEAR(source.values[k], truth, kSmoothing * 1e3 * kSize_m * (kRate + l)) << k;
  }
}

}  // namespace
}  // namespace workbench::diagnose
