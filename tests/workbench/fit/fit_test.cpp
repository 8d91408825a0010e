// The command: files in, words, JSON, report and model file out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "plant_sim/model_file.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"
#include "tests/workbench/run_command.h"

namespace workbench::fit {

namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using workbench_test::run_command;

const std::string kModels = SPOOLWATCH_SOURCE_DIR "/config/models/";

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class FitTest : public testing::Test {
 protected:
  FitTest() {
    std::string name = (fs::temp_directory_path() / "fit-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    truth::write_csv(truth::simulate(truth::parse_case("motion=multisine,length_s=10", 7)),
                     record());
  }
  ~FitTest() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string record() const { return (folder_ / "record.csv").string(); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  static std::string fit(std::vector<std::string> arguments) {
    return workbench_test::printed_by(workbench::cli::add_fit, std::move(arguments));
  }
  std::string refusal(std::vector<std::string> arguments, int exit_code) const {
    arguments.insert(arguments.end(), {"-o", path("out.toml"), "--json", path("out.json")});
    testing::internal::CaptureStdout();
    std::string said = "no refusal";
    try {
      run_command(workbench::cli::add_fit, std::move(arguments));
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), exit_code) << error.what();
      said = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_THAT(said, Not(HasSubstr("\n")));
    EXPECT_FALSE(fs::exists(path("out.toml")));
    EXPECT_FALSE(fs::exists(path("out.json")));
    return said;
  }

  fs::path folder_;
};

// By hand: `add` an effect without a value, then `fit`.
TEST_F(FitTest, FitsAnEffectThatWasAddedWithoutAValue) {
  truth::write_csv(truth::simulate(truth::parse_case(
                       "motion=multisine,length_s=10,null_bias.offset_V=-0.07", 7)),
                   path("biased.csv"));
  std::ofstream(path("neutral.toml"))
      << text_of(kModels + "thesis.toml") << "\n[effects.null_bias]\n";
  fit({path("neutral.toml"), path("biased.csv"), "-o", path("fitted.toml")});
  plant_sim::ModelFile fitted = plant_sim::load_model(path("fitted.toml"));
  EXPECT_NEAR(*fitted.value("null_bias.offset_V"), -0.07, 1e-3);
}

TEST_F(FitTest, WritesTheBetterModelAndSaysWhatMoved) {
  const std::string said =
      fit({kModels + "thesis.toml", record(), "--fit", "blocks", "-o", path("better.toml"),
           "--json", path("fit.json"), "--report", path("fit.html")});
  EXPECT_THAT(said, AllOf(HasSubstr("RMS, drift-corrected"), HasSubstr("On data that were not"),
                          HasSubstr("Parameters that the record does not determine"),
                          HasSubstr("starts ended in this minimum"), HasSubstr("Moved:")));
  const auto json = nlohmann::json::parse(text_of(path("fit.json")));
  EXPECT_LT(json["rms_after_m"], 0.5 * double(json["rms_before_m"]));
  EXPECT_LT(json["heldout_after_m"], 0.5 * double(json["heldout_before_m"]));
  const auto& gain = json["parameters"]["valve_gain_m_per_V"];
  EXPECT_EQ(gain["start"], 2.79e-5);
  auto model = plant_sim::load_model(path("better.toml"));
  EXPECT_DOUBLE_EQ(*model.value("valve_gain_m_per_V"), gain["value"]);
  EXPECT_EQ(*model.value("area_m2"), 6.33e-4);
  EXPECT_THAT(text_of(path("better.toml")), HasSubstr("# Fitted by: spoolwatch fit "));
  EXPECT_THAT(text_of(path("fit.html")),
              AllOf(HasSubstr("Correlation of the estimates"), HasSubstr("spoolwatch fit")));
  // The model that it writes can be fitted again, and there is nothing more to gain.
  fit({path("better.toml"), record(), "--fit", "blocks", "--json", path("again.json")});
  const auto again = nlohmann::json::parse(text_of(path("again.json")));
  EXPECT_NEAR(double(again["rms_after_m"]) / double(json["rms_after_m"]), 1.0, 0.01);
}

TEST_F(FitTest, IgnoredSpansDoNotCount) {
  // A second of nonsense in the middle of the record.
  std::ifstream in(record());
  std::ofstream out(path("bent.csv"));
  std::string line;
  for (int row = 0; std::getline(in, line); ++row) {
    if (row > 1000 && row <= 1200) {
      double t_s = 0.0;
      double u_V = 0.0;
      double y_m = 0.0;
      std::sscanf(line.c_str(), "%lf,%lf,%lf", &t_s, &u_V, &y_m);
      char bent[96];
      std::snprintf(bent, sizeof bent, "%.9g,%.9g,%.9g", t_s, u_V, y_m + 1e-3 * (row % 7));
      line = bent;
    }
    out << line << '\n';
  }
  out.close();
  const std::string free = "valve_gain_m_per_V,damping_N_s_per_m";
  const auto rms = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{kModels + "thesis.toml",
                                       path("bent.csv"),
                                       "--free",
                                       free,
                                       "--json",
                                       "-",
                                       "--profile",
                                       "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return double(nlohmann::json::parse(fit(arguments))["rms_after_m"]);
  };
  EXPECT_GT(rms({}), 100e-6);
  // The observer's memory of the nonsense dies away in 3 s.
  EXPECT_LT(rms({"--ignore", "4.9:10"}), 10e-6);
}

TEST_F(FitTest, RefusesBadRequestsInOneLineAndWritesNothing) {
  const std::string model = kModels + "thesis.toml";
  EXPECT_THAT(refusal({model, record(), "--free", "valve_gain"}, 78), HasSubstr("is no parameter"));
  EXPECT_THAT(refusal({model, record(), "--profile", "mass"}, 78), HasSubstr("is not fitted"));
  EXPECT_THAT(refusal({model, record(), "--holdout", record()}, 2), HasSubstr("is fitted too"));
  EXPECT_THAT(refusal({model, record(), record()}, 2), HasSubstr("given twice"));
  EXPECT_THAT(refusal({model, record(), "--ignore", "5:4"}, 2), HasSubstr("from:to"));
  EXPECT_THAT(refusal({model, record(), "--ignore", "50:60"}, 2), HasSubstr("no sample"));
  EXPECT_THAT(refusal({model, record(), "--ignore", "0:60"}, 2), HasSubstr("fewer than 10"));
  EXPECT_THAT(refusal({model, record(), "--weight", "1", "--weight", "2"}, 2),
              HasSubstr("one for each of the 1 records"));
  EXPECT_THAT(refusal({model, record(), "--observer", "300"}, 2), HasSubstr("too fast"));
  EXPECT_THAT(refusal({model, "/nowhere.csv"}, 65), HasSubstr("/nowhere.csv"));
  EXPECT_THAT(refusal({"/nowhere.toml", record()}, 78), HasSubstr("/nowhere.toml"));
  EXPECT_THAT(refusal({model, record(), "--set", "parameters.mas_kg=3"}, 78), HasSubstr("mass_kg"));
  EXPECT_THAT(refusal({model, record(), "--report", "/nowhere/fit.html"}, 1),
              HasSubstr("does not exist"));
  EXPECT_THAT(refusal({model, record(), "--report", record()}, 2), HasSubstr("overwrite an input"));
  EXPECT_THAT(refusal({model, record(), "--report", path("out.json")}, 2),
              HasSubstr("two outputs"));
}

TEST_F(FitTest, RefusesARecordWithoutMotionAndNotesASaturatedOne) {
  std::ofstream still(path("still.csv"));
  still << "t_s,u_V,y_m\n";
  for (int k = 0; k < 1000; ++k) still << 0.005 * k << ",0,0.305\n";
  still.close();
  EXPECT_THAT(refusal({kModels + "thesis.toml", path("still.csv")}, 65),
              HasSubstr("does not move"));
  std::ofstream full(path("full.csv"));
  full << "t_s,u_V,y_m\n";
  for (int k = 0; k < 1000; ++k) full << 0.005 * k << ",1," << 0.05 + 0.0002 * k << "\n";
  full.close();
  EXPECT_THAT(fit({kModels + "thesis.toml", path("full.csv"), "--profile", "none"}),
              HasSubstr("the command never changes"));
}

// Published: Janot, Gautier, Brunot, Data set and reference models of EMPS (2019), by another
// method (inverse dynamics, least squares) from the same experiment.
TEST(FitEmps, AgreesWithThePublishedParameters) {
  const char* const given = std::getenv("SPOOLWATCH_DATA");
  std::string folder = given != nullptr ? given : SPOOLWATCH_SOURCE_DIR "/../shared/data";
  const std::string record = folder + "/emps/train_200Hz.csv";
  if (!fs::exists(record)) GTEST_SKIP() << record << " is not here; set SPOOLWATCH_DATA";
  const auto json = nlohmann::json::parse(workbench_test::printed_by(
      workbench::cli::add_fit,
      {kModels + "force_driven_axis.toml", record, "--set", "parameters.gain_N_per_V=35.15065",
       "--set", "effects.friction.coulomb_N=10", "--set", "effects.load_force.force_N=1",
       "--observer", "0", "--json", "-"}));
  const std::vector<std::pair<std::string, double>> published{{"mass_kg", 95.11},
                                                              {"damping_N_s_per_m", 203.5},
                                                              {"friction.coulomb_N", 20.39},
                                                              {"load_force.force_N", -3.165}};
  for (const auto& [name, value] : published) {
    const auto& p = json["parameters"][name];
    // A standard error from the interval, which is the profile's where that is no parabola.
    const double error = (double(p["high"]) - double(p["low"])) / (2.0 * 1.96);
    std::printf("  %-20s %8.3f +- %.3f, published %.3f\n", name.c_str(), double(p["value"]), error,
                value);
    // The rest, 1000 times the noise, is friction that depends on the direction: the offset
    // takes some of it up, which no standard error covers.
    const double allowed = name == "load_force.force_N" ? 0.25 : 3.0 * error;
    EXPECT_LT(std::abs(double(p["value"]) - value), allowed) << name;
  }
  // Free run 2.58 mm with these three effects, fitted to the free run itself.
  EXPECT_NEAR(double(json["free_run_after_m"]), 2.58e-3, 0.1e-3);
}

}  // namespace
}  // namespace workbench::fit
