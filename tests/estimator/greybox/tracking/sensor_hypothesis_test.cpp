// A position sensor that is suspected and reads wrongly is not taken for a change of the rig alone.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;

constexpr double kFault_s = 15.2;
constexpr double kCentre_m = 0.305;

/// The loop's record where the sensor shows s times the way from the centre: to the loop that is a
/// rig that moves 1 / s of the way at a gain s times as high, in coordinates s times as long.
truth::Record scaled(double s, std::size_t seed) {
  truth::Case before = stand(kFault_s, seed);
  truth::Case after = stand(30.0, seed);
  after.kp_V_per_m *= s;
  truth::Record whole = truth::simulate(before);
  const truth::Record rest = truth::simulate(after);
  for (std::size_t k = whole.t_s.size(); k < rest.t_s.size(); ++k) {
    whole.t_s.push_back(rest.t_s[k]);
    whole.u_V.push_back(rest.u_V[k]);
    whole.y_m.push_back(kCentre_m + s * (rest.y_m[k] - kCentre_m));
  }
  return whole;
}

iso::TrackerSettings suspecting() {
  iso::TrackerSettings settings;
  settings.thresholds.suspect_position_sensor = true;
  return settings;
}

bool has_sensor(const iso::DetectedChange& alarm) {
  return std::any_of(alarm.named.rivals.begin(), alarm.named.rivals.end(), [](const auto& rival) {
    return rival.name.rfind("position_sensor.", 0) == 0;
  });
}

TEST(Sensor, OfAnotherScaleIsInTheGroupOfEveryAlarmThatItRaises) {
  for (const double s : {1.05, 0.95}) {
    const Tracked t = tracked(scaled(s, 1), usual(), suspecting());
    ASSERT_FALSE(t.alarms.empty()) << s;
    bool is_scale = false;
    for (const iso::DetectedChange& alarm : t.alarms) {
      EXPECT_TRUE(has_sensor(alarm)) << t.name(alarm) << ' ' << s << ' ' << alarm.raised_s;
      for (const iso::Rival& rival : alarm.named.rivals) {
        if (rival.name != "position_sensor.scale_ratio") continue;
        is_scale = true;
        EXPECT_NEAR(rival.value, s - 1.0, 1e-3);
      }
    }
    EXPECT_TRUE(is_scale) << s;
  }
}

TEST(Sensor, IsNoRivalOfADampingThatChanges) {
  for (const double factor : {1.25, 0.75}) {
    truth::Case of = stand(25.0);
    fault(of, kFault_s, &truth::Plant::damping_N_s_per_m, factor);
    const Tracked t = tracked(truth::simulate(of), usual(), suspecting());
    ASSERT_EQ(t.alarms.size(), 1u);
    EXPECT_EQ(t.name(t.alarms[0]), "damping_N_s_per_m");
    EXPECT_FALSE(has_sensor(t.alarms[0]));
  }
}

TEST(Sensor, IsInNoGroupWhereItIsNotSuspected) {
  const Tracked t = tracked(scaled(1.05, 1));
  ASSERT_FALSE(t.alarms.empty());
  for (const iso::DetectedChange& alarm : t.alarms)
    EXPECT_FALSE(has_sensor(alarm)) << t.name(alarm);
}

}  // namespace
