// The command as people and scripts call it: determinism, bad arguments, exit codes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "config/record/record.h"
#include "plant_sim/model_file.h"
#include "tests/workbench/simulate/program.h"

namespace workbench::simulate {
namespace {

using testing::HasSubstr;

const std::string kModel =
    std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis_calibrated.toml";
const std::string kNoise =
    " --set instruments.noise_m=2e-6 --set instruments.encoder_resolution_m=5e-6";

std::string simulate(const std::string& output, const std::string& more) {
  return "simulate " + kModel + " -o " + output + ' ' + more;
}

void expect_refused(const Outcome& outcome, int exit_code, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr(part));
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
}

TEST(SimulateProgram, WritesARecordThatReadsBack) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv");
  ASSERT_EQ(run_program(simulate(file, "--duration 2")).exit_code, 0);
  const auto record = config::record::read_record(file);
  ASSERT_EQ(record.size(), 400U);
  EXPECT_DOUBLE_EQ(record.sample_time_s, 0.005);
  const auto* reference_m = record.column("reference_m");
  ASSERT_NE(reference_m, nullptr);
  for (std::size_t k = 0; k < record.size(); ++k) {
    ASSERT_NEAR((*reference_m)[k], 0.305 + 0.0254 * std::sin(M_PI * 0.005 * double(k)), 1e-12);
    ASSERT_NEAR(record.u_V[k], 250.0 * ((*reference_m)[k] - record.y_m[k]), 1e-12);
  }
}

TEST(SimulateProgram, NamesTheChangesAndFaultsBehindItsEnd) {
  const TemporaryFolder folder;
  const std::string model = folder.file("late.toml");
  std::ofstream(model) << text_of(kModel) << "\n[[change]]\nparameter = \"mass_kg\"\nat_s = 3.0\n"
                       << "value = 60.0\n[[change]]\nparameter = \"bulk_modulus_Pa\"\n"
                       << "at_s = 1.0\nvalue = 6e8\n";
  const std::string call = "simulate " + model + " -o " + folder.file("a.csv");
  const Outcome late = run_program(call + " --duration 2 --fault supply_pressure_Pa*1.1@2");
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_EQ(late.error, "spoolwatch: " + model +
                            ": the change of mass_kg at 3 s never sets in: the simulation ends at "
                            "2 s\nspoolwatch: " +
                            model +
                            ": the change of supply_pressure_Pa at 2 s never sets in: the "
                            "simulation ends at 2 s\n");
  const Outcome open = run_program("simulate " + model + " -o " + folder.file("b.csv") +
                                   " --command " + folder.file("a.csv"));
  EXPECT_EQ(open.exit_code, 0);
  EXPECT_THAT(open.error,
              HasSubstr("mass_kg at 3 s never sets in: the simulation ends at 1.995 s"));
  EXPECT_EQ(run_program(call + " --duration 4").error, "");
}

TEST(SimulateProgram, WritesPressuresWithNoiseWhereAskedTo) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv");
  const std::string still = "--duration 5 --set reference.amplitude_m=0";
  ASSERT_EQ(run_program(simulate(file, still + " --pressures --pressure-noise 5000")).exit_code, 0);
  const auto record = config::record::read_record(file);
  const auto* supply_Pa = record.column("supply_pressure_Pa");
  const auto* in_Pa = record.column("pressure_in_Pa");
  const auto* out_Pa = record.column("pressure_out_Pa");
  ASSERT_TRUE(supply_Pa != nullptr && in_Pa != nullptr && out_Pa != nullptr);
  const double declared_Pa = *plant_sim::load_model(kModel).value("supply_pressure_Pa");
  double squares_Pa2 = 0.0;
  double sum_Pa = 0.0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    squares_Pa2 += std::pow((*supply_Pa)[k] - declared_Pa, 2);
    sum_Pa += (*in_Pa)[k] + (*out_Pa)[k];
  }
  const auto samples = static_cast<double>(record.size());
  // 1000 numbers: standard deviations of the RMS and of the mean, four to either side
  EXPECT_NEAR(std::sqrt(squares_Pa2 / samples), 5000.0, 4.0 * 5000.0 / std::sqrt(2.0 * samples));
  EXPECT_NEAR(sum_Pa / samples, declared_Pa, 4.0 * 5000.0 * std::sqrt(2.0 / samples) + 1.0);
  ASSERT_EQ(run_program(simulate(folder.file("b.csv"), still)).exit_code, 0);
  EXPECT_EQ(config::record::read_record(folder.file("b.csv")).y_m, record.y_m);
}

TEST(SimulateProgram, RefusesPressuresThatThereAreNot) {
  const TemporaryFolder folder;
  expect_refused(
      run_program("simulate " + std::string(SPOOLWATCH_SOURCE_DIR) +
                  "/config/models/velocity_servo.toml -o " + folder.file("a.csv") + " --pressures"),
      78, "velocity_servo has none");
  expect_refused(run_program(simulate(folder.file("a.csv"), "--pressure-noise 10")), 2,
                 "needs --pressures");
}

TEST(SimulateProgram, SameSeedSameBytesAnotherSeedOthers) {
  const TemporaryFolder folder;
  const std::string more = "--duration 3 --seed 7" + kNoise;
  ASSERT_EQ(run_program(simulate(folder.file("a.csv"), more)).exit_code, 0);
  ASSERT_EQ(run_program(simulate(folder.file("b.csv"), more)).exit_code, 0);
  ASSERT_EQ(run_program(simulate(folder.file("c.csv"), "--duration 3 --seed 8" + kNoise)).exit_code,
            0);
  EXPECT_EQ(text_of(folder.file("a.csv")), text_of(folder.file("b.csv")));
  EXPECT_NE(text_of(folder.file("a.csv")), text_of(folder.file("c.csv")));
}

TEST(SimulateProgram, FaultsAndReferencesChangeTheRecord) {
  const TemporaryFolder folder;
  std::string before;
  for (const char* more :
       {"", "--fault 'supply_pressure_Pa*0.5@0.5'", "--reference multisine",
        "--reference prbs --set reference.hold_s=0.2", "--set reference.amplitude_m=0.01",
        "--set parameters.mass_kg=60", "--set effects.friction.coulomb_N=100"}) {
    const Outcome outcome =
        run_program(simulate(folder.file("a.csv"), std::string("--duration 1 ") + more));
    ASSERT_EQ(outcome.exit_code, 0) << more << outcome.error;
    const std::string text = text_of(folder.file("a.csv"));
    EXPECT_NE(text, before) << more;
    before = text;
  }
}

/// A fault that does nothing, a motion of no sines and a period of 5/3 steps are mistakes.
TEST(SimulateProgram, RefusesWhatCannotBeMeant) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv");
  expect_refused(run_program(simulate(file, "--fault 'friction.coulomb_N*2@5'")), 78, "factor");
  expect_refused(
      run_program(simulate(file, "--reference multisine --set 'reference.frequencies_Hz=[]'")), 78,
      "frequencies_Hz");
  expect_refused(run_program(simulate(file, "--set step_s=0.003")), 78, "step_s");
  EXPECT_FALSE(std::filesystem::exists(file));
}

/// A replay of the record needs both to know that an estimate over saturated samples is not valid.
TEST(SimulateProgram, RecordsTheVoltageAskedForAndTheSaturation) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv");
  ASSERT_EQ(run_program(simulate(file, "--duration 2 --set instruments.dac_range_V=0.5")).exit_code,
            0);
  const auto record = config::record::read_record(file);
  const auto* requested_V = record.column("u_requested_V");
  const auto* saturated = record.column("saturated");
  ASSERT_NE(requested_V, nullptr);
  ASSERT_NE(saturated, nullptr);
  int count = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const bool beyond = std::abs((*requested_V)[k]) > 0.5;
    EXPECT_EQ((*saturated)[k], beyond ? 1.0 : 0.0) << k;
    EXPECT_DOUBLE_EQ(std::clamp((*requested_V)[k], -0.5, 0.5), record.u_V[k]) << k;
    count += beyond ? 1 : 0;
  }
  EXPECT_GT(count, 10);
}

TEST(SimulateProgram, TakesTheReferenceFromAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("r.csv")) << "t_s,reference_m\n0,0.305\n1,0.315\n";
  ASSERT_EQ(run_program(
                simulate(folder.file("a.csv"), "--duration 1 --reference " + folder.file("r.csv")))
                .exit_code,
            0);
  const auto record = config::record::read_record(folder.file("a.csv"));
  EXPECT_NEAR((*record.column("reference_m"))[100], 0.310, 1e-12);
}

TEST(SimulateProgram, RefusesAnUnknownParameterAndNamesANearOne) {
  const TemporaryFolder folder;
  expect_refused(
      run_program(simulate(folder.file("a.csv"), "--set parameters.suply_pressure_Pa=1e6")), 78,
      "supply_pressure_Pa");
  expect_refused(run_program(simulate(folder.file("a.csv"), "--fault suply_pressure_Pa=1e6@1")), 78,
                 "supply_pressure_Pa");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.csv")));
}

TEST(SimulateProgram, RefusesBadArgumentsInOneLine) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv");
  expect_refused(run_program("simulate /nowhere.toml -o " + file), 78, "/nowhere.toml");
  expect_refused(run_program(simulate("/nowhere/a.csv", "")), 1, "/nowhere does not exist");
  expect_refused(run_program(simulate(file, "--reference sawtooth")), 2, "multisine");
  expect_refused(run_program(simulate(file, "--set parameters.mass_kg")), 2, "table.key=value");
  expect_refused(run_program(simulate(file, "--set parameters.mass_kg=-1")), 78, "mass_kg");
  expect_refused(run_program(simulate(file, "--fault mass_kg")), 2, "PARAMETER=VALUE@SECONDS");
  expect_refused(run_program(simulate(file, "--set initial.y_m=0.7")), 78, "y_m");
  for (const char* bad : {"--duration -1", "--duration nan", "--duration inf", "--seed -1"}) {
    EXPECT_EQ(run_program(simulate(file, bad)).exit_code, 2) << bad;
  }
  EXPECT_EQ(run_program("simulate " + kModel).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace workbench::simulate
