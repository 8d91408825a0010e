#include "estimator/greybox/selection/remaining_disturbance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;

constexpr double kHum_m = 20e-6;
constexpr double kHum_Hz = 17.0;

double hum_m(double y_m, double t_s) {
  return y_m + kHum_m * std::sin(2.0 * std::numbers::pi * kHum_Hz * t_s);
}

/// A random speed of 1 mm/s RMS, first-order low-passed at 1 Hz, the same each time.
double wandering_mps(double t_s) {
  constexpr double kTs_s = 0.005;
  static const std::vector<double> speeds_mps = [] {
    std::mt19937 random(11);
    std::normal_distribution<double> drawn(0.0, 1e-3);
    const double kept = std::exp(-2.0 * std::numbers::pi * kTs_s);
    std::vector<double> series{drawn(random)};
    while (series.size() <= 4000) {
      series.push_back(kept * series.back() + std::sqrt(1.0 - kept * kept) * drawn(random));
    }
    return series;
  }();
  return speeds_mps.at(static_cast<std::size_t>(t_s / kTs_s));
}

std::optional<RemainingDisturbance> found(const diagnose_test::ServoRun& run) {
  return remaining_disturbance(diagnose_test::servo_model(), diagnose_test::servo_record(run), {});
}

TEST(RemainingDisturbance, IsTheRandomSpeedThatMovesAServo) {
  const auto left = found({.rate_mps = [](double u_V, double, double t_s) {
    return kServoGain * u_V + wandering_mps(t_s);
  }});
  ASSERT_TRUE(left);
  EXPECT_EQ(left->disturbance.as, "speed");
  // 20 s hold some 60 independent values of it: 10 % of the RMS either way, three of these
  EXPECT_NEAR(left->disturbance.value, 1e-3, 0.3e-3);
  EXPECT_GT(left->floor_m, 5e-5);
}

TEST(RemainingDisturbance, IsTheHumOfASensor) {
  const auto left = found({.rate_mps = [](double u_V, double, double) { return kServoGain * u_V; },
                           .reading_m = hum_m});
  ASSERT_TRUE(left);
  ASSERT_EQ(left->disturbance.lines.size(), 1U);
  // to an integrator a periodic speed is the same: one is named, the other its rival
  const DisturbanceLine& line = left->disturbance.lines[0];
  std::vector<LineRival> kinds = line.rivals;
  kinds.push_back({line.as, line.amplitude});
  const auto sensor = std::find_if(kinds.begin(), kinds.end(),
                                   [](const LineRival& kind) { return kind.as == "sensor"; });
  ASSERT_NE(sensor, kinds.end());
  EXPECT_NEAR(line.frequency_Hz, kHum_Hz, 0.01);
  EXPECT_NEAR(sensor->amplitude, kHum_m, 1e-6);
}

TEST(RemainingDisturbance, IsNoneWhereOnlyTheSensorsNoiseIsLeft) {
  EXPECT_FALSE(found({.rate_mps = [](double u_V, double, double) { return kServoGain * u_V; }}));
}

TEST(RemainingDisturbance, IsNoneWhereTheModelIsOffInAParameter) {
  EXPECT_FALSE(found({.rate_mps = [](double u_V, double, double t_s) {
    return 1.05 * kServoGain * u_V + wandering_mps(t_s);
  }}));
}

TEST(RemainingDisturbance, IsNoneWhereAnEffectIsMissingBesideIt) {
  const diagnose_test::Rate band = diagnose_test::with_offset_and_band(0.0, 0.1);
  EXPECT_FALSE(found({.rate_mps = [&](double u_V, double y_m, double t_s) {
    return band(u_V, y_m, t_s) + wandering_mps(t_s);
  }}));
}

TEST(RemainingDisturbance, IsNoneWhereALoadSetsIn) {
  const Dataset record = diagnose_test::dataset_of(truth::simulate(
      truth::parse_case("motion=multisine,length_s=20,outside.force_N=20,outside.corner_Hz=3,"
                        "left_out=load_step,left_out.size=600,left_out.where=12",
                        71)));
  EXPECT_FALSE(remaining_disturbance(diagnose_test::thesis(), record, {}));
}

TEST(RemainingDisturbance, IsNotKnownOnceItIsCancelled) {
  const Dataset record =
      diagnose_test::servo_record({.rate_mps = [](double u_V, double, double t_s) {
        return kServoGain * u_V + wandering_mps(t_s);
      }});
  DiagnosisOptions options;
  options.cancel = [] { return true; };
  EXPECT_FALSE(remaining_disturbance(diagnose_test::servo_model(), record, options));
}

}  // namespace
}  // namespace estimator::greybox::selection
