// Tracking of a rig with process disturbance, on records of the independent truth generator: 30 N
// of random force below 3 Hz and 1 bar of pump pulsation at 23 Hz.
#include <gmock/gmock.h>

#include "estimator/greybox/tracking/disturbed_baseline.h"
#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using testing::Contains;
using testing::HasSubstr;

constexpr double kLearned_s = 60.0;

truth::Case disturbed_stand(double length_s, std::size_t seed) {
  truth::Case of = stand(length_s, seed);
  of.outside.force_N = 30.0;
  of.outside.corner_Hz = 3.0;
  of.outside.pulsation_Pa = 1e5;
  of.outside.pulsation_Hz = 23.0;
  return of;
}

std::optional<iso::Baseline> learned(const truth::Record& record, const iso::ParameterSet& set) {
  const auto end = static_cast<std::ptrdiff_t>(kLearned_s / truth::kSample_s);
  return iso::learn_disturbed_baseline(
      printed_model(), set,
      estimator::greybox::dataset_of(truth::kSample_s,
                                     {record.u_V.begin(), record.u_V.begin() + end},
                                     {record.y_m.begin(), record.y_m.begin() + end}),
      2);
}

Tracked tracked_disturbed(const truth::Record& record) {
  Tracked out;
  const plant_sim::ModelFile model = printed_model();
  out.set = iso::choose(model, usual(), "parameters");
  out.baseline = learned(record, out.set).value();
  iso::ParameterTracker tracker(model, out.set, {}, truth::kSample_s, kFloor_m);
  tracker.take(out.baseline);
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    auto window = tracker.push(record.t_s[k], record.u_V[k], record.y_m[k], k == 0);
    if (window) out.windows.push_back(*window);
  }
  out.alarms = tracker.detector().changes();
  return out;
}

/// Estimates of a parameter within three of their own standard errors, as a ratio to the valid
/// ones.
double share_within_three(const Tracked& result, std::size_t parameter, double value, double from_s,
                          double to_s) {
  double valid = 0.0;
  double within = 0.0;
  for (const iso::WindowResult& window : result.windows) {
    if (window.t_s < from_s || window.t_s >= to_s) continue;
    const iso::ParameterEstimate& one = window.estimates[parameter];
    if (!one.valid) continue;
    valid += 1.0;
    if (std::abs(one.value - value) <= 3.0 * one.std_error) within += 1.0;
  }
  return within / valid;
}

TEST(DisturbedTracking, TheDisturbanceIsMeasuredAndTheHealthyRigRaisesNoAlarm) {
  const truth::Record record = truth::simulate(disturbed_stand(110.0, 9101));
  const Tracked result = tracked_disturbed(record);
  const iso::ProcessNoise& noise = result.baseline.noise.value();
  EXPECT_NEAR(noise.healthy.random, 30.0, 0.25 * 30.0);
  ASSERT_FALSE(noise.model.lines.empty());
  EXPECT_EQ(noise.site_name(noise.model.lines[0].site), "pressure");
  EXPECT_NEAR(noise.model.lines[0].frequency_Hz, 23.0, 0.1);
  // One pressure line over a minute: its amplitude is known to about 8 %.
  EXPECT_NEAR(noise.healthy.line_values[0], 1e5, 0.25 * 1e5);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    EXPECT_LT(std::abs(result.baseline.theta[at] - result.set.file[at]),
              4.0 * std::sqrt(noise.covariance(at, at)));
  }
  EXPECT_TRUE(result.alarms.empty());
  EXPECT_GT(share_within_three(result, 0, 6.89e6, 0.0, 110.0), 0.95);
  EXPECT_GT(share_within_three(result, 1, 1000.0, 0.0, 110.0), 0.95);
  ASSERT_TRUE(result.windows.back().level.has_value());
  EXPECT_NEAR(result.windows.back().level->random, 30.0, 0.4 * 30.0);  // of eight seconds
}

TEST(DisturbedTracking, ASupplyPressureIsNamedWithinTwoSecondsAndItsReturn) {
  truth::Case of = disturbed_stand(90.0, 9102);
  fault(of, 70.2, &truth::Plant::supply_pressure_Pa, 0.9);
  fault(of, 80.2, &truth::Plant::supply_pressure_Pa, 1.0);
  const Tracked result = tracked_disturbed(truth::simulate(of));
  ASSERT_EQ(result.alarms.size(), 1u);
  const iso::DetectedChange& alarm = result.alarms[0];
  EXPECT_EQ(result.name(alarm), "supply_pressure_Pa");
  EXPECT_GT(alarm.raised_s, 70.2);
  EXPECT_LT(alarm.raised_s, 72.2);
  EXPECT_GT(alarm.cleared_s, 80.2);
  EXPECT_LT(alarm.cleared_s, 83.2);
  const auto& p = result.set.parameters[0];
  const double error_Pa = alarm.named.std_error * p.slope(alarm.named.theta);
  EXPECT_NEAR(p.to_physical(alarm.named.theta), 0.9 * 6.89e6, 4.0 * error_Pa);
  EXPECT_LT(error_Pa, 0.005 * 6.89e6);
  ASSERT_FALSE(alarm.named.rivals.empty());
  EXPECT_EQ(alarm.named.rivals[0].name, "valve_gain_m_per_V");
  EXPECT_GT(share_within_three(result, 0, 0.9 * 6.89e6, 72.2, 80.2), 0.95);
}

TEST(DisturbedTracking, ADampingIsNamed) {
  truth::Case of = disturbed_stand(100.0, 9103);
  fault(of, 70.2, &truth::Plant::damping_N_s_per_m, 1.5);
  const Tracked result = tracked_disturbed(truth::simulate(of));
  ASSERT_EQ(result.alarms.size(), 1u);
  const iso::DetectedChange& alarm = result.alarms[0];
  EXPECT_EQ(result.name(alarm), "damping_N_s_per_m");
  EXPECT_GT(alarm.raised_s, 70.2);
  EXPECT_LT(alarm.raised_s, 90.0);
  EXPECT_TRUE(alarm.active());
  const auto& p = result.set.parameters[1];
  const double error = alarm.named.std_error * p.slope(alarm.named.theta);
  EXPECT_NEAR(p.to_physical(alarm.named.theta), 1500.0, 4.0 * error);
}

TEST(DisturbedTracking, AnUndisturbedRigHasNoDisturbance) {
  const iso::ParameterSet set = iso::choose(printed_model(), usual(), "parameters");
  EXPECT_FALSE(learned(truth::simulate(stand(kLearned_s, 9104)), set).has_value());
}

}  // namespace
