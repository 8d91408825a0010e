// The simulated loop: order of reading and writing, instruments, faults.
#include "workbench/simulate/closed_loop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

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

/// The readings of 2 s of the loop.
std::vector<double> read_with(const SensorFault& fault) {
  Scenario scenario = thesis();
  scenario.sensor_faults.push_back(fault);
  ClosedLoop loop(scenario, 1);
  std::vector<double> y_m(400);
  for (double& y : y_m) y = loop.step().y_m;
  return y_m;
}

std::vector<double> read_healthy() {
  ClosedLoop loop(thesis(), 1);
  std::vector<double> y_m(400);
  for (double& y : y_m) y = loop.step().y_m;
  return y_m;
}

TEST(ClosedLoop, SensorFaultIsSeenByTheControllerFromItsTimeOn) {
  const std::vector<double> healthy = read_healthy();
  const std::vector<double> faulty = read_with({"offset", 1.0, 1e-3});
  for (std::size_t k = 0; k < 200; ++k) ASSERT_EQ(faulty[k], healthy[k]) << k;
  EXPECT_NEAR(faulty[200], healthy[200] + 1e-3, 1e-12);
  // The loop takes the offset back: the reading, not the rod, follows the reference again.
  EXPECT_NEAR(faulty[399], healthy[399], 2e-5);
}

TEST(ClosedLoop, FrozenSensorReadsItsLastValueForGood) {
  const std::vector<double> healthy = read_healthy();
  const std::vector<double> faulty = read_with({"freeze", 0.5, 0.0});
  for (std::size_t k = 0; k < 100; ++k) ASSERT_EQ(faulty[k], healthy[k]) << k;
  for (std::size_t k = 100; k < 400; ++k) ASSERT_EQ(faulty[k], healthy[99]) << k;
}

TEST(FaultySensor, DriftsAndScalesFromWhereItWas) {
  FaultySensor drifting({{"drift", 2.0, 1e-3}});
  EXPECT_EQ(drifting.signal_m(1.0, 0.3), 0.3);
  EXPECT_NEAR(drifting.signal_m(5.0, 0.3), 0.303, 1e-15);
  FaultySensor scaled({{"scale", 2.0, 0.1}});
  EXPECT_EQ(scaled.signal_m(1.0, 0.2), 0.2);
  EXPECT_EQ(scaled.signal_m(2.0, 0.3), 0.3);
  EXPECT_NEAR(scaled.signal_m(3.0, 0.32), 0.322, 1e-15);
  EXPECT_NEAR(scaled.signal_m(4.0, 0.25), 0.245, 1e-15);
}

}  // namespace
}  // namespace workbench::simulate
