#include "hal/sim/sim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "config/schema/error.h"

namespace hal::sim {
namespace {

constexpr double kTs_s = 0.005;

std::unique_ptr<plant_sim::Plant> plant() { return plant_sim::make_plant(plant_sim::ModelFile()); }

SimConfig ideal() {
  SimConfig config;
  config.encoder_resolution_m = 0.0;
  config.dac_bits = 0;
  return config;
}

Tick tick(std::int64_t index) { return {index, index * 5'000'000}; }

TEST(SimRig, ReadsThePlantUnderTheVoltageWrittenLast) {
  SimRig rig(plant(), ideal(), kTs_s, 0.0);
  const std::unique_ptr<plant_sim::Plant> twin = plant();
  for (std::int64_t k = 0; k < 200; ++k) {
    EXPECT_DOUBLE_EQ(rig.read(tick(k)).y_m, twin->reading_m()) << "tick " << k;
    const double u_V = std::sin(0.05 * static_cast<double>(k));
    const Applied applied = rig.write(u_V, tick(k));
    EXPECT_EQ(applied.u_V, u_V);
    EXPECT_TRUE(applied.good);
    twin->advance(u_V, kTs_s);
  }
}

TEST(SimRig, HoldsTheVoltageOverSkippedTicks) {
  SimRig rig(plant(), ideal(), kTs_s, 0.0);
  const std::unique_ptr<plant_sim::Plant> twin = plant();
  rig.read(tick(0));
  rig.write(0.7, tick(0));
  for (int k = 0; k < 8; ++k) twin->advance(0.7, kTs_s);
  EXPECT_DOUBLE_EQ(rig.read(tick(8)).y_m, twin->reading_m());
}

TEST(SimRig, GivesTheSameReadingsForTheSameSeedOnly) {
  const auto readings = [](std::int64_t seed) {
    SimConfig config;
    config.noise_m = 2e-6;
    config.seed = seed;
    SimRig rig(plant(), config, kTs_s, 0.0);
    std::vector<double> y_m;
    for (std::int64_t k = 0; k < 100; ++k) {
      y_m.push_back(rig.read(tick(k)).y_m);
      rig.write(0.1, tick(k));
    }
    return y_m;
  };
  EXPECT_EQ(readings(4), readings(4));
  EXPECT_NE(readings(4), readings(5));
}

TEST(SimRig, AppliesTheConvertersStepsAndRange) {
  SimConfig config = ideal();
  config.dac_bits = 12;
  config.dac_range_V = 10.0;
  SimRig rig(plant(), config, kTs_s, 0.0);
  constexpr double kStep_V = 20.0 / 4096.0;
  EXPECT_DOUBLE_EQ(rig.write(0.4 * kStep_V, tick(0)).u_V, 0.0);
  EXPECT_DOUBLE_EQ(rig.write(2.6 * kStep_V, tick(0)).u_V, 3.0 * kStep_V);
  EXPECT_DOUBLE_EQ(rig.write(99.0, tick(0)).u_V, 10.0 - kStep_V);
  EXPECT_DOUBLE_EQ(rig.read(tick(0)).command_V, 10.0 - kStep_V);
}

TEST(SimRig, GoesToTheConfiguredNullAndStartsThere) {
  SimRig rig(plant(), ideal(), kTs_s, 0.35);
  EXPECT_DOUBLE_EQ(rig.read(tick(0)).command_V, 0.35);
  rig.write(2.0, tick(0));
  EXPECT_DOUBLE_EQ(rig.go_null().u_V, 0.35);
  EXPECT_DOUBLE_EQ(rig.read(tick(1)).command_V, 0.35);
}

TEST(SimRig, FaultsComeAtTheirTime) {
  SimConfig config = ideal();
  plant_sim::Change fault;
  fault.parameter = "supply_pressure_Pa";
  fault.at_s = 0.5;
  fault.factor = 0.5;
  config.faults = {fault};
  SimRig faulty(plant(), config, kTs_s, 0.0);
  SimRig healthy(plant(), ideal(), kTs_s, 0.0);
  for (std::int64_t k = 0; k <= 150; ++k) {
    const double difference_m = faulty.read(tick(k)).y_m - healthy.read(tick(k)).y_m;
    if (k <= 100) {
      EXPECT_EQ(difference_m, 0.0) << "tick " << k;
    } else if (k == 150) {
      EXPECT_LT(difference_m, -1e-4) << "half the pressure moves the rod less";
    }
    faulty.write(1.0, tick(k));
    healthy.write(1.0, tick(k));
  }
}

TEST(SimRig, RefusesAFaultOfAParameterThatThereIsNot) {
  SimConfig config;
  plant_sim::Change fault;
  fault.parameter = "suply_pressure_Pa";
  fault.factor = 0.5;
  config.faults = {fault};
  EXPECT_THROW(SimRig(plant(), config, kTs_s, 0.0), config::schema::Error);
}

TEST(SpareRod, HasNoiseAndTroublesOfItsOwn) {
  SimConfig config = ideal();
  InjectedFault drift;
  drift.kind = "drift";
  drift.rod = "b";
  drift.from_s = 0.1;
  drift.rate_mps = 0.01;
  InjectedFault frozen;
  frozen.kind = "frozen";  // the rig's own
  frozen.from_s = 0.1;
  config.injected_faults = {drift, frozen};
  const auto rig = std::make_shared<SimRig>(plant(), config, kTs_s, 0.0);
  SpareConfig spare;
  spare.id = "b";
  spare.offset_m = 1e-3;
  SpareRod b(rig, spare, config.injected_faults);
  spare.id = "c";
  spare.noise_m = 1e-5;
  SpareRod c(rig, spare, config.injected_faults, 7);
  double squares = 0.0;
  double frozen_at_m = 0.0;
  for (std::int64_t k = 0; k < 400; ++k) {
    const double own_m = rig->read(tick(k)).y_m;
    rig->write(0.5, tick(k));
    const double y_m = rig->position_m();
    const double drift_m = k < 20 ? 0.0 : 0.01 * (static_cast<double>(k) * kTs_s - 0.1);
    EXPECT_NEAR(b.read(tick(k)).y_m, y_m + 1e-3 + drift_m, 1e-12) << k;
    const double noise_m = c.read(tick(k)).y_m - y_m - 1e-3;
    squares += noise_m * noise_m;
    if (k < 20) frozen_at_m = own_m;
    if (k >= 20) {
      EXPECT_EQ(own_m, frozen_at_m) << k;
    }
  }
  // 400 squares of a normal number: 7 % of standard deviation, five of them.
  EXPECT_NEAR(squares / 400.0, 1e-10, 0.36e-10);
}

}  // namespace
}  // namespace hal::sim
