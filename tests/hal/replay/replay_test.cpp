#include "hal/replay/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace hal::replay {
namespace {

config::record::Record ramp(int rows) {
  config::record::Record record;
  record.sample_time_s = 0.01;
  for (int i = 0; i < rows; ++i) {
    record.t_s.push_back(i * 0.01);
    record.u_V.push_back(0.5 * i);
    record.y_m.push_back(0.001 * i);
  }
  return record;
}

Tick tick(std::int64_t index) { return {index, index * 10'000'000}; }

TEST(ReplaySensor, GivesPositionAndCommandRowByRowThenTheEnd) {
  ReplaySensor sensor(ramp(5));
  for (int i = 0; i < 5; ++i) {
    const Reading reading = sensor.read(tick(i));
    EXPECT_EQ(reading.y_m, 0.001 * i);
    EXPECT_EQ(reading.command_V, 0.5 * i);
    EXPECT_EQ(reading.quality, config::signals::Quality::good);
    EXPECT_FALSE(reading.end);
  }
  EXPECT_TRUE(sensor.read(tick(5)).end);
  EXPECT_TRUE(sensor.read(tick(6)).end);
}

TEST(ReplaySensor, PeriodsThatTheRecordLacksReadAsMissing) {
  config::record::Record record = ramp(6);
  for (std::size_t i = 3; i < 6; ++i) record.t_s[i] += 0.04;  // four periods lost before row 3
  record.gaps = {3};
  ReplaySensor sensor(record);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(sensor.read(tick(i)).y_m, 0.001 * i);
  for (int i = 3; i < 7; ++i) {
    const Reading reading = sensor.read(tick(i));
    EXPECT_EQ(reading.quality, config::signals::Quality::bad);
    EXPECT_TRUE(std::isnan(reading.y_m));
    EXPECT_FALSE(reading.end);
  }
  for (int i = 3; i < 6; ++i) EXPECT_EQ(sensor.read(tick(i + 4)).y_m, 0.001 * i);
  EXPECT_TRUE(sensor.read(tick(10)).end);
}

TEST(ReplaySensor, LeavesOutTheRowsOfTicksThatWereSkipped) {
  ReplaySensor sensor(ramp(10));
  EXPECT_EQ(sensor.read(tick(0)).y_m, 0.0);
  EXPECT_EQ(sensor.read(tick(6)).y_m, 0.006);
}

TEST(ReplaySensor, KeepsTheQualityThatTheRecordStates) {
  config::record::Record record = ramp(4);
  record.further = {{"quality", {0.0, 1.0, 3.0, std::nan("")}}};
  ReplaySensor sensor(record);
  EXPECT_EQ(sensor.read(tick(0)).quality, config::signals::Quality::good);
  EXPECT_EQ(sensor.read(tick(1)).quality, config::signals::Quality::uncertain);
  EXPECT_EQ(sensor.read(tick(2)).quality, config::signals::Quality::bad);
  EXPECT_EQ(sensor.read(tick(3)).quality, config::signals::Quality::good);
}

/// Estimates over saturated samples are not valid, on the stand and in a replay.
TEST(ReplaySensor, KeepsTheSaturationThatTheRecordStates) {
  config::record::Record record = ramp(3);
  record.further = {{"saturated", {0.0, 1.0, std::nan("")}}};
  ReplaySensor sensor(record);
  EXPECT_FALSE(sensor.read(tick(0)).saturated);
  EXPECT_TRUE(sensor.read(tick(1)).saturated);
  EXPECT_FALSE(sensor.read(tick(2)).saturated);
}

TEST(ReplayInput, GivesItsColumnRowByRowAndNothingWhereThereIsNone) {
  const auto record = std::make_shared<config::record::Record>(ramp(6));
  for (std::size_t i = 3; i < 6; ++i) record->t_s[i] += 0.02;  // two periods lost before row 3
  record->gaps = {3};
  record->further = {{"pressure_in_Pa", {1e6, 2e6, std::nan(""), 4e6, 5e6, 6e6}}};
  ReplayInput input(record, record->further[0].second);
  const double wanted_Pa[] = {1e6, 2e6, kMissing, kMissing, kMissing, 4e6, 5e6, 6e6, kMissing};
  for (int i = 0; i < 9; ++i) {
    const InputReading reading = input.read(tick(i));
    if (std::isnan(wanted_Pa[i])) {
      EXPECT_TRUE(std::isnan(reading.value)) << i;
      EXPECT_EQ(reading.quality, config::signals::Quality::bad) << i;
    } else {
      EXPECT_EQ(reading.value, wanted_Pa[i]) << i;
      EXPECT_EQ(reading.quality, config::signals::Quality::good) << i;
    }
  }
}

TEST(ReplayBackend, OffersThePressuresThatTheRecordHas) {
  const auto file = std::filesystem::temp_directory_path() / "spoolwatch_replay_pressure.csv";
  std::ofstream(file) << "t_s,u_V,y_mm,supply_pressure_bar,other_Pa\n"
                         "0,1,2,70,1\n0.02,1,3,71,1\n0.04,1,4,72,1\n";
  ReplayBackend backend;
  config::schema::Document::parse("schema_version = 1\nrecord = \"" + file.string() + "\"\n",
                                  "test")
      .read([&](config::schema::Visitor& v) { backend.visit(v); });
  const BackendDevices devices = backend.open({"test", {}, 0.005, 0.0});
  std::filesystem::remove(file);
  ASSERT_EQ(devices.inputs.size(), 1U);
  // A bar is 1e5 Pa; the product may miss it by a rounding.
  EXPECT_NEAR(devices.inputs.at("supply_pressure")->read(tick(1)).value, 7.1e6, 1e-8);
}

TEST(ReplayBackend, TakesThePeriodFromTheRecordAndDrivesNothing) {
  const auto file = std::filesystem::temp_directory_path() / "spoolwatch_replay_test.csv";
  std::ofstream(file) << "t_s,u_V,y_mm\n0,1,2\n0.02,1,3\n0.04,1,4\n0.06,1,5\n";
  ReplayBackend backend;
  config::schema::Document::parse(
      "schema_version = 1\nrecord = \"" + file.string() + "\"\npace = \"fast\"\n", "test")
      .read([&](config::schema::Visitor& v) { backend.visit(v); });
  const BackendDevices devices = backend.open({"test", {}, 0.005, 0.0});
  EXPECT_DOUBLE_EQ(devices.sample_time_s, 0.02);
  EXPECT_TRUE(devices.fast);
  EXPECT_EQ(devices.valve, nullptr);
  EXPECT_DOUBLE_EQ(devices.rods.at(kRodChannel)->read(tick(1)).y_m, 0.003);
  std::filesystem::remove(file);
  try {
    (void)backend.open({"test", {}, 0.005, 0.0});
    FAIL() << "a missing record was opened";
  } catch (const config::schema::ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("[replay] record"), std::string::npos);
  }
}

}  // namespace
}  // namespace hal::replay
