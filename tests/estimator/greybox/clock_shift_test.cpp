// The shift between two clocks, of a motion that is known at every time.
#include "estimator/greybox/clock_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace estimator::greybox {
namespace {

constexpr double kSampleTime_s = 0.005;

double position_m(double t_s) { return 0.02 * std::sin(2.3 * t_s) + 0.01 * std::sin(5.1 * t_s); }

double speed_mps(double t_s) { return 0.046 * std::cos(2.3 * t_s) + 0.051 * std::cos(5.1 * t_s); }

/// Shift that is found where the modelled speed is `late` samples late.
double found(double late, double by_response) {
  std::vector<double> y_m;
  std::vector<double> modelled_mps;
  for (int k = 0; k < 4000; ++k) {
    y_m.push_back(position_m(k * kSampleTime_s));
    modelled_mps.push_back(speed_mps((k - late) * kSampleTime_s));
  }
  const std::vector<double> u_V(y_m.size(), 0.0);
  return command_late_samples(dataset_of(kSampleTime_s, u_V, y_m), modelled_mps, by_response);
}

TEST(ClockShift, IsFoundFarFromWhatTheResponseShows) {
  EXPECT_EQ(found(40.0, 40.0), 40.0);
  EXPECT_EQ(found(40.0, 20.0), 40.0) << "a servo that lags by 100 ms";
  EXPECT_EQ(found(40.0, 60.0), 40.0);
}

TEST(ClockShift, IsNoneWhereTheModelsMotionIsOnTime) { EXPECT_EQ(found(0.0, 5.0), 0.0); }

TEST(ClockShift, IsNoneInARecordTooShortToShowIt) { EXPECT_EQ(found(40.0, 3950.0), 0.0); }

}  // namespace
}  // namespace estimator::greybox
