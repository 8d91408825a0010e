// The rig's physics against a twin that is advanced by hand. Times are given, nothing waits.
#include "hal/hil_rig/bench_rig.h"

#include <gmock/gmock.h>

#include <cmath>

#include "config/schema/error.h"

namespace hal::hil_rig {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 1'000'000'000'000;

std::int64_t at(double t_s) { return kStart_ns + std::llround(t_s * 1e9); }

RigConfig ideal() {
  RigConfig config;
  config.file = "rig.toml";
  config.folder = SPOOLWATCH_SOURCE_DIR "/config";
  config.sim.model = "models/thesis.toml";
  config.sim.encoder_resolution_m = 0.0;
  config.sim.dac_bits = 0;
  return config;
}

std::unique_ptr<plant_sim::Plant> twin() {
  plant_sim::ModelFile model =
      plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/thesis.toml");
  model.step_s = 1e-4;
  return plant_sim::make_plant(model);
}

TEST(BenchRig, ItsTransducersHaveTheErrorsDeclared) {
  RigConfig config = ideal();
  plant_sim::TransducerConfig drifted;
  drifted.of = "pressure_in";
  drifted.offset_Pa = 2e5;
  drifted.from_s = 0.1;
  config.sim.pressures = {drifted};
  BenchRig rig(config, kStart_ns);
  const auto plant = twin();
  rig.advance_to(at(0.2));
  EXPECT_DOUBLE_EQ(rig.read_pressure_Pa(1), plant->pressures().in_Pa)
      << "schedules count from the first command";
  rig.command(1.0);
  rig.advance_to(at(0.4));
  plant->advance(0.0, 0.2);
  plant->advance(1.0, 0.2);
  EXPECT_DOUBLE_EQ(rig.read_pressure_Pa(0), plant->pressures().supply_Pa);
  EXPECT_DOUBLE_EQ(rig.read_pressure_Pa(1), plant->pressures().in_Pa + 2e5);
  EXPECT_DOUBLE_EQ(rig.read_pressure_Pa(2), plant->pressures().out_Pa);
  config.sim.pressures.push_back(drifted);
  EXPECT_THROW(BenchRig(config, kStart_ns), config::schema::Error);
}

TEST(BenchRig, HoldsTheCommandUntilTheNext) {
  BenchRig rig(ideal(), kStart_ns);
  const auto plant = twin();
  rig.advance_to(at(0.5));  // without a command: null
  plant->advance(0.0, 0.5);
  rig.command(2.0);
  rig.advance_to(at(0.5037));
  plant->advance(2.0, 0.0037);
  EXPECT_DOUBLE_EQ(rig.read_position_m(), plant->reading_m());
  rig.command(-1.0);
  rig.advance_to(at(0.7));
  plant->advance(-1.0, 0.1963);
  EXPECT_DOUBLE_EQ(rig.read_position_m(), plant->reading_m());
  EXPECT_EQ(rig.time_us(), 700'000U);
}

TEST(BenchRig, GoesToItsNullWhenTheTimeOutEndsHoweverLateSomebodyLooks) {
  RigConfig config = ideal();
  config.field.null_V = 0.1;
  config.field.command_timeout_s = 0.05;
  BenchRig rig(config, kStart_ns);
  const auto plant = twin();
  rig.command(2.0);
  EXPECT_EQ(rig.status(), kCommanded);
  rig.advance_to(at(1.0));
  plant->advance(2.0, 0.05);
  plant->advance(0.1, 0.95);
  EXPECT_DOUBLE_EQ(rig.read_position_m(), plant->reading_m());
  EXPECT_EQ(rig.status(), kCommanded | kTimedOut);
  EXPECT_DOUBLE_EQ(rig.converter_V(), 0.1);
  rig.command(1.0);
  EXPECT_DOUBLE_EQ(rig.converter_V(), 1.0);
  EXPECT_EQ(rig.status(), kCommanded);
}

TEST(BenchRig, CountsFaultsFromTheFirstCommand) {
  RigConfig config = ideal();
  plant_sim::Change fault;
  fault.parameter = "supply_pressure_Pa";
  fault.at_s = 0.2;
  fault.factor = 0.5;
  config.sim.faults = {fault};
  BenchRig rig(config, kStart_ns);
  const auto plant = twin();
  rig.advance_to(at(3.0));
  plant->advance(0.0, 3.0);
  rig.command(1.0);
  rig.advance_to(at(3.4));
  plant->advance(1.0, 0.2);
  *plant->parameter("supply_pressure_Pa") *= 0.5;
  plant->advance(1.0, 0.2);
  EXPECT_DOUBLE_EQ(rig.read_position_m(), plant->reading_m());
}

TEST(BenchRig, IsWiredAsTheFieldSays) {
  RigConfig config = ideal();
  config.field.valve_sign = -1.0;
  config.field.valve_scale = 0.5;
  config.field.encoder_sign = -1.0;
  config.field.encoder_scale = 2.0;
  config.field.encoder_offset_m = 0.1;
  config.sim.encoder_resolution_m = 1e-5;
  BenchRig rig(config, kStart_ns);
  const auto plant = twin();
  rig.command(2.0);
  rig.advance_to(at(0.3));
  plant->advance(-1.0, 0.3);
  const double expected_m = -2.0 * plant->reading_m() + 0.1;
  const double reading_m = rig.read_position_m();
  EXPECT_NEAR(reading_m, expected_m, 0.5e-5 + 1e-12);
  EXPECT_EQ(rig.counts(reading_m), std::lround(expected_m / 1e-5));
}

TEST(BenchRig, HasAConverterOfItsBitsAndRange) {
  RigConfig config = ideal();
  config.sim.dac_bits = 12;
  BenchRig rig(config, kStart_ns);
  rig.command(1.003);
  EXPECT_DOUBLE_EQ(rig.converter_V(), 205 * 20.0 / 4096);  // 1.00098, the nearest code
  rig.command(99.0);
  EXPECT_DOUBLE_EQ(rig.converter_V(), 10.0 - 20.0 / 4096);
  rig.command(std::nan(""));
  EXPECT_DOUBLE_EQ(rig.asked_V(), 99.0) << "no number is no command";
}

TEST(BenchRig, EStopAndAMissingPermitPutTheValveToNull) {
  RigConfig config = ideal();
  config.field.permit_timeout_s = 0.02;
  BenchRig rig(config, kStart_ns);
  rig.command(2.0);
  EXPECT_EQ(rig.converter_V(), 0.0) << "no permit yet";
  rig.permit(true);
  EXPECT_EQ(rig.converter_V(), 2.0);
  rig.advance_to(at(0.015));
  rig.permit(false);  // a change is what counts
  rig.advance_to(at(0.030));
  EXPECT_EQ(rig.converter_V(), 2.0);
  rig.permit(false);
  rig.advance_to(at(0.036));
  EXPECT_EQ(rig.converter_V(), 0.0);
  EXPECT_EQ(rig.status() & kPermitMissing, kPermitMissing);
  rig.permit(true);
  EXPECT_EQ(rig.set("e_stop=0"), "");
  EXPECT_EQ(rig.converter_V(), 0.0);
  EXPECT_FALSE(rig.e_stop_released());
  EXPECT_EQ(rig.set("e_stop=1"), "");
  EXPECT_EQ(rig.converter_V(), 2.0);
  EXPECT_EQ(rig.set("enable=0"), "");
  EXPECT_EQ(rig.status(), kCommanded | kNotEnabled);
}

TEST(BenchRig, TakesFaultsWhileItRuns) {
  BenchRig rig(ideal(), kStart_ns);
  const auto plant = twin();
  EXPECT_EQ(rig.set("supply_pressure_Pa=x0.5"), "");
  EXPECT_EQ(rig.set("supply_pressure_Pa=x0.75"), "") << "of the value at the start";
  EXPECT_EQ(rig.set("friction.coulomb_N=100"), "");
  *plant->parameter("supply_pressure_Pa") *= 0.75;
  *plant->parameter("friction.coulomb_N") = 100.0;
  rig.command(1.0);
  rig.advance_to(at(0.5));
  plant->advance(1.0, 0.5);
  EXPECT_DOUBLE_EQ(rig.read_position_m(), plant->reading_m());
  EXPECT_EQ(rig.set("encoder_frozen=1"), "");
  const double frozen_m = rig.read_position_m();
  rig.advance_to(at(0.6));
  EXPECT_EQ(rig.read_position_m(), frozen_m);
  EXPECT_EQ(rig.set("mute_s=0.2"), "");
  EXPECT_FALSE(rig.mute()) << "whoever asked gets an answer";
  rig.advance_to(at(0.71));
  EXPECT_TRUE(rig.mute());
  rig.advance_to(at(0.91));
  EXPECT_FALSE(rig.mute());
}

TEST(BenchRig, SaysWhatIsWrongWithASetting) {
  BenchRig rig(ideal(), kStart_ns);
  EXPECT_THAT(rig.set("suply_pressure_Pa=1"), HasSubstr("names no parameter"));
  EXPECT_THAT(rig.set("e_stop"), HasSubstr("name=value"));
  EXPECT_THAT(rig.set("e_stop=off"), HasSubstr("has no number"));
  EXPECT_THAT(rig.set("e_stop=2"), HasSubstr("out of range"));
  EXPECT_THAT(rig.set("supply_pressure_Pa=nan"), HasSubstr("has no number"));
}

TEST(BenchRig, RefusesAFaultOfAParameterThatThereIsNot) {
  RigConfig config = ideal();
  plant_sim::Change fault;
  fault.parameter = "suply_pressure_Pa";
  fault.factor = 0.5;
  config.sim.faults = {fault};
  try {
    BenchRig rig(config, kStart_ns);
    FAIL() << "accepted";
  } catch (const config::schema::ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("rig.toml: [[sim.fault]]"));
  }
}

}  // namespace
}  // namespace hal::hil_rig
