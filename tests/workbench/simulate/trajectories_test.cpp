// Trajectories out of the program: compare --residuals and simulate --command agree with what
// compare prints, and with the closed loop that made the record.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/record/record.h"
#include "tests/workbench/simulate/program.h"

namespace workbench::simulate {
namespace {

using config::record::read_record;
using config::record::Record;
using testing::HasSubstr;

const std::string kModels = std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/";
const std::string kModel = kModels + "thesis_calibrated.toml";

class Trajectories : public testing::Test {
 protected:
  Trajectories() {
    EXPECT_EQ(run_program("simulate " + kModel + " -o " + record_ +
                          " --duration 8 --reference "
                          "multisine --set instruments.noise_m=2e-6")
                  .exit_code,
              0);
  }
  static double rms(const std::vector<double>& values) {
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / static_cast<double>(values.size()));
  }

  TemporaryFolder folder_;
  std::string record_ = folder_.file("record.csv");
};

TEST_F(Trajectories, OfCompareAreTheNumbersThatItPrints) {
  const std::string model = kModels + "thesis.toml";
  for (const char* name : {"out.csv", "out.mat", "out.h5"}) {
    std::string file = folder_.file(name);
    const Outcome run =
        run_program("compare " + model + " " + record_ + " --json - --residuals " + file);
    ASSERT_EQ(run.exit_code, 0) << run.error;
    const auto printed = nlohmann::json::parse(run.output);
    if (file.ends_with(".h5")) {  // this program reads no HDF5, the other one does
      const std::string back = folder_.file("back.csv");
      ASSERT_EQ(run_program("import " + file + " -o " + back).exit_code, 0);
      file = back;
    }
    const Record out = read_record(file);
    const Record in = read_record(record_);
    ASSERT_EQ(out.size(), in.size());
    EXPECT_EQ(out.y_m, in.y_m);
    const auto& free_m = *out.column("free_run_residual_m");
    EXPECT_NEAR(rms(free_m), printed["free_run_rms_m"].get<double>(), 1e-12);
    for (std::size_t k = 0; k < out.size(); ++k) {
      // The states' run is a second simulation of the same motion.
      ASSERT_DOUBLE_EQ(out.y_m[k] - (*out.column("free_run_m"))[k], free_m[k]) << name << k;
    }
    EXPECT_NE(out.column("state_v_mps"), nullptr);
    EXPECT_NE(out.column("residual_m"), nullptr);
  }
}

TEST_F(Trajectories, OfARecordedCommandFollowTheLoopThatMadeIt) {
  const std::string file = folder_.file("open.csv");
  const Outcome run = run_program("simulate " + kModel + " --command " + record_ + " -o " + file);
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Record out = read_record(file);
  const auto& measured_m = *out.column("measured_m");
  for (std::size_t k = 0; k < out.size(); ++k) {
    // Noise of the reading, and a start that the noise shifts; the plant is stable but integrating.
    ASSERT_NEAR(out.y_m[k], measured_m[k], 5e-5) << k;
  }
}

TEST_F(Trajectories, NeedNoPositionBesideTheCommand) {
  const std::string file = folder_.file("command.csv");
  std::ofstream text(file);
  text << "Time [s];Command [V]\n";
  for (int k = 0; k < 300; ++k) text << k * 0.005 << ';' << std::sin(0.02 * k) << '\n';
  text.close();
  const std::string out = folder_.file("open.mat");
  const Outcome run = run_program("simulate " + kModel + " --command " + file + " -o " + out);
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(read_record(out).size(), 300U);
  EXPECT_EQ(read_record(out).column("measured_m"), nullptr);
  EXPECT_THAT(run_program("compare " + kModel + " " + file).error,
              HasSubstr("lacks a position column"));
}

TEST_F(Trajectories, RefuseWhatHasNoMeaning) {
  const std::string out = folder_.file("out.csv");
  EXPECT_EQ(
      run_program("simulate " + kModel + " --command " + record_ + " --seed 3 -o " + out).exit_code,
      2);
  EXPECT_EQ(run_program("simulate " + kModel + " --map u=1 -o " + out).exit_code, 2);
  EXPECT_EQ(run_program("compare " + kModel + " " + record_ + " --residuals out.xls").exit_code, 2);
  EXPECT_EQ(run_program("compare " + kModel + " " + record_ + " --residuals " + record_).exit_code,
            2);
}

TEST_F(Trajectories, LeaveOutWhatCompareIsToIgnore) {
  std::ifstream in(record_);
  const std::string spiked = folder_.file("spiked.csv");
  std::ofstream out(spiked);
  std::string line;
  for (int k = 0; std::getline(in, line); ++k) {
    if (k == 801) {  // a reading of 9.99 m at 4 s
      const auto first = line.find(',');
      const auto second = line.find(',', first + 1);
      const auto third = line.find(',', second + 1);
      line = line.substr(0, second + 1) + "9.99" + line.substr(third);
    }
    out << line << '\n';
  }
  out.close();
  const auto rms_m = [&](const std::string& more) {
    const Outcome run = run_program("compare " + kModel + " " + spiked + " --json - " + more);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return nlohmann::json::parse(run.output)["rms_m"].get<double>();
  };
  EXPECT_GT(rms_m(""), 0.05);
  EXPECT_LT(rms_m("--ignore 3.99:4.01"), 1e-4);
  EXPECT_THAT(run_program("import " + spiked).output, HasSubstr("9.99 m at 4 s"));
}

}  // namespace
}  // namespace workbench::simulate
