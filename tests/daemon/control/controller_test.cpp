#include "daemon/control/controller.h"

#include <gtest/gtest.h>

namespace monitor::control {
namespace {

constexpr double kTs_s = 0.005;

TEST(Controller, IsProportionalAboutNull) {
  Controller controller({200.0}, {0.3, 10.0}, kTs_s);
  const ValveCommand command = controller.update(0.31, 0.30);
  EXPECT_DOUBLE_EQ(command.requested_V, 0.3 + 200.0 * (0.31 - 0.30));
  EXPECT_DOUBLE_EQ(command.limited_V, command.requested_V);
  EXPECT_FALSE(command.saturated);
}

TEST(Controller, LimitsTheDistanceFromNullBothWays) {
  Controller controller({1000.0}, {0.5, 4.0}, kTs_s);
  EXPECT_DOUBLE_EQ(controller.update(1.0, 0.0).limited_V, 4.5);
  const ValveCommand low = controller.update(-1.0, 0.0);
  EXPECT_DOUBLE_EQ(low.limited_V, -3.5);
  EXPECT_TRUE(low.saturated);
}

TEST(Controller, SlewsFromNullAtTheConfiguredRate) {
  Controller controller({100.0}, {1.0, 10.0, 40.0}, kTs_s);  // 0.2 V a period
  for (int k = 1; k <= 10; ++k) {
    EXPECT_NEAR(controller.update(0.02, 0.0).limited_V, 1.0 + 0.2 * k, 1e-12) << "period " << k;
  }
  EXPECT_NEAR(controller.update(0.02, 0.0).limited_V, 3.0, 1e-12);
  EXPECT_FALSE(controller.update(0.02, 0.0).saturated);
}

TEST(Controller, AllowsTheSlewOfThePeriodsThatPassed) {
  Controller controller({100.0}, {0.0, 10.0, 40.0}, kTs_s);
  EXPECT_NEAR(controller.update(1.0, 0.0, 4).limited_V, 0.8, 1e-12);
}

TEST(Controller, BeginsAtNullAgainAfterAReset) {
  Controller controller({100.0}, {0.0, 10.0, 40.0}, kTs_s);
  for (int k = 0; k < 20; ++k) controller.update(1.0, 0.0);
  controller.reset();
  EXPECT_NEAR(controller.update(1.0, 0.0).limited_V, 0.2, 1e-12);
}

}  // namespace
}  // namespace monitor::control
