// Slow changes are followed, by the rule of baseline_drift.h and on records of the
// independent generator.
#include "estimator/greybox/tracking/baseline_drift.h"

#include <gmock/gmock.h>

#include "config/schema/error.h"
#include "estimator/fdi/tracker/tracker_config.h"
#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using testing::HasSubstr;

constexpr double kStride_s = 0.5;

iso::ParameterSet usual_choice() { return iso::choose(printed_model(), usual(), "parameters"); }

/// An explained window in which damping is found at `x`.
iso::WindowResult window_at(double t_s, double x, bool valid = true) {
  iso::WindowResult window;
  window.t_s = t_s;
  window.estimates.resize(2);
  window.estimates[1].theta = x;
  window.estimates[1].valid = valid;
  return window;
}

struct Followed {
  iso::ParameterSet set = usual_choice();
  iso::ChangeDetector alarms{set, {}};
  iso::BaselineDrift slow;
  Eigen::VectorXd baseline = set.file;

  explicit Followed(double ratio_per_h, double most_ratio)
      : slow(set, {{"damping_N_s_per_m"}, ratio_per_h, most_ratio}) {
    slow.take(baseline);
  }
};

TEST(BaselineDrift, GoesNoFasterThanItsRate) {
  Followed f(0.36, 0.3);  // 1e-4 a second
  for (int k = 0; k <= 200; ++k) {
    f.slow.follow(window_at(k * kStride_s, -0.2), true, f.alarms, f.baseline);
  }
  EXPECT_NEAR(f.baseline[1], -100.0 * 1e-4, 1e-12);  // 100 s
  EXPECT_EQ(f.baseline[0], f.set.file[0]);
  EXPECT_EQ(f.slow.at_end(0, f.baseline), 0);
}

TEST(BaselineDrift, TellsTheEndOfTheDistanceThatIsFollowed) {
  Followed f(36.0, 0.3);
  for (int k = 0; k <= 200; ++k) {
    f.slow.follow(window_at(k * kStride_s, 0.5), true, f.alarms, f.baseline);
  }
  EXPECT_NEAR(std::exp(f.baseline[1]), 1.3, 1e-12);
  EXPECT_EQ(f.slow.at_end(0, f.baseline), 1);
}

TEST(BaselineDrift, CountsTheTimeInWhichTheMotionToldNothing) {
  Followed f(0.36, 0.3);
  f.slow.follow(window_at(0.0, -0.05), true, f.alarms, f.baseline);
  for (int k = 1; k < 200; ++k) {
    f.slow.follow(window_at(k * kStride_s, -0.05, false), true, f.alarms, f.baseline);
  }
  EXPECT_EQ(f.baseline[1], 0.0);
  f.slow.follow(window_at(100.0, -0.05), true, f.alarms, f.baseline);  // 1e-2 are allowed by now
  EXPECT_NEAR(f.baseline[1], -0.2 * 0.05, 1e-12);
}

TEST(BaselineDrift, StandsStillWhereTheModelDoesNotExplainTheRig) {
  Followed f(0.36, 0.3);
  for (int k = 0; k <= 200; ++k) {
    f.slow.follow(window_at(k * kStride_s, -0.2), false, f.alarms, f.baseline);
  }
  EXPECT_EQ(f.baseline[1], 0.0);
}

TEST(BaselineDrift, RefusesAParameterThatIsNotTracked) {
  try {
    iso::BaselineDrift(usual_choice(), {{"mass_kg"}, 0.5, 0.3}, "[[tracker]] physics: follow");
    FAIL() << "was taken";
  } catch (const config::schema::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("[[tracker]] physics: follow: names mass_kg"));
    EXPECT_THAT(error.what(), HasSubstr("supply_pressure_Pa, damping_N_s_per_m"));
  }
}

/// Damping falls in small steps, by 10 % in five minutes, as it would in twenty.
truth::Record warming(double fault_at_s) {
  truth::Case of = stand(360.0);
  for (int second = 20; second < 320; ++second) {
    const double factor = 1.0 - 0.1 * (second - 20) / 300.0;
    const bool faulty = fault_at_s > 0.0 && second >= fault_at_s;
    fault(of, second, &truth::Plant::damping_N_s_per_m, factor * (faulty ? 1.25 : 1.0));
  }
  return truth::simulate(of);
}

iso::TrackerSettings following() {
  iso::TrackerSettings settings;
  settings.drift = {{"damping_N_s_per_m"}, 2.0, 0.3};
  return settings;
}

TEST(BaselineDrift, OfDampingIsNoAlarmWhereItIsFollowed) {
  const truth::Record record = warming(0.0);
  EXPECT_FALSE(tracked(record).alarms.empty());
  const Tracked followed = tracked(record, usual(), following());
  EXPECT_TRUE(followed.alarms.empty());
  // The windows go on to find the rig's own value.
  EXPECT_NEAR(followed.windows.back().estimates[1].value, 900.0, 30.0);
}

TEST(BaselineDrift, LeavesAFaultOfDampingToBeNamed) {
  const Tracked found = tracked(warming(200.0), usual(), following());
  ASSERT_EQ(found.alarms.size(), 1u);
  EXPECT_EQ(found.name(found.alarms[0]), "damping_N_s_per_m");
  EXPECT_GT(found.alarms[0].raised_s, 200.0);
  EXPECT_LT(found.alarms[0].raised_s, 203.0);
  EXPECT_TRUE(found.alarms[0].active());
}

}  // namespace
