// The simulated loop: order of reading and writing, instruments, faults.
#include "workbench/simulate/closed_loop.h"

#include <gmock/gmock.h>

#include <cmath>

namespace workbench::simulate {
namespace {

Scenario thesis() {
  Scenario scenario;
  scenario.model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                         "/config/models/thesis_calibrated.toml");
  return scenario;
}

TEST(ClosedLoop, ReadsThePositionBeforeItWritesTheVoltage) {
  Scenario scenario = thesis();
  scenario.reference.centre_m = 0.315;
  scenario.reference.amplitude_m = 0.0;
  ClosedLoop loop(scenario, 1);
  const LoopRow first = loop.step();
  EXPECT_EQ(first.y_m, 0.305);
  EXPECT_NEAR(first.u_applied_V, 250.0 * 0.01, 1e-12);
  EXPECT_GT(loop.step().y_m, 0.305);
}

TEST(ClosedLoop, FollowsTheProportionalLawAtEverySample) {
  ClosedLoop loop(thesis(), 1);
  for (int k = 0; k < 1000; ++k) {
    const LoopRow row = loop.step();
    EXPECT_EQ(row.t_s, k * 0.005);
    ASSERT_NEAR(row.u_applied_V, 250.0 * (row.reference_m - row.y_m), 1e-12);
  }
}

TEST(ClosedLoop, LimitsAtTheRangeOfTheConverterAndSaysSo) {
  Scenario scenario = thesis();
  scenario.reference.centre_m = 0.5;
  ClosedLoop loop(scenario, 1);
  const LoopRow row = loop.step();
  EXPECT_TRUE(row.saturated);
  EXPECT_EQ(row.u_applied_V, 10.0);
  EXPECT_NEAR(row.u_requested_V, 250.0 * 0.195, 1e-9);
}

TEST(ClosedLoop, MeasuresInWholeEncoderStepsAndWritesWholeCodes) {
  Scenario scenario = thesis();
  scenario.instruments = {5e-6, 2e-6, 12, 10.0};
  ClosedLoop loop(scenario, 1);
  const double code_V = 20.0 / 4096.0;
  for (int k = 0; k < 500; ++k) {
    const LoopRow row = loop.step();
    ASSERT_NEAR(row.y_m / 5e-6, std::round(row.y_m / 5e-6), 1e-6);
    ASSERT_NEAR(row.u_applied_V / code_V, std::round(row.u_applied_V / code_V), 1e-9);
  }
}

TEST(ClosedLoop, FaultActsFromItsTimeOnAndNotBefore) {
  Scenario scenario = thesis();
  ClosedLoop healthy(scenario, 1);
  plant_sim::Change change;
  change.parameter = "supply_pressure_Pa";
  change.at_s = 1.0;
  change.factor = 0.5;
  scenario.faults.push_back(change);
  ClosedLoop faulty(scenario, 1);
  for (int k = 0; k < 400; ++k) {
    const double difference_m = healthy.step().y_m - faulty.step().y_m;
    if (k <= 200) {
      ASSERT_EQ(difference_m, 0.0) << k;
    } else if (k > 210) {
      ASSERT_NE(difference_m, 0.0) << k;
    }
  }
}

}  // namespace
}  // namespace workbench::simulate
