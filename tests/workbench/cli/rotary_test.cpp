// Every command that prints about a rotary axis says so: angles, torques, no rod that extends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "config/schema/error.h"
#include "tests/workbench/run_command.h"

namespace workbench::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using workbench_test::printed_by;

/// Words and units of a linear axis in `text`, each with the word behind it.
std::vector<std::string> linear_words(const std::string& text) {
  static const std::set<std::string> kLinear{
      "mm",     "um",  "µm",        "kN",         "N/m",       "mm/s",       "um/s", "m/s",
      "mm/s/V", "N/V", "extending", "retracting", "extension", "retraction", "rod",  "stroke"};
  std::vector<std::string> found;
  std::istringstream words(text);
  std::string before;
  for (std::string word; words >> word; before = word) {
    while (!word.empty() && std::string(".,:;()*").find(word.back()) != std::string::npos) {
      word.pop_back();
    }
    if (before == "N" && word != "m" && word.rfind("m/", 0) != 0) found.push_back("N " + word);
    if (before == "kg" && word != "m2") found.push_back("kg " + word);
    if (kLinear.count(word) > 0) found.push_back(before + " " + word);
  }
  return found;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Rotary : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    says(add_new, {"rotary-servo", "--full-speed-rpm", "30", "-o", model});
    says(add_add, {model, "null_bias", "offset_V=0.05", "-o", file("biased.toml")});
    says(add_simulate, {file("biased.toml"), "--duration", "20", "--reference", "multisine",
                        "--set", "instruments.noise_m=1e-5", "-o", record});
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string file(const std::string& name) const { return (folder / name).string(); }
  /// What the command prints, without a word of a linear axis.
  static std::string says(cli::Setup setup, std::vector<std::string> arguments) {
    std::string text = printed_by(setup, std::move(arguments));
    EXPECT_THAT(linear_words(text), testing::IsEmpty()) << text;
    return text;
  }
  void expect_report_of_angles(const std::string& name) const {
    const std::string html = text_of(file(name));
    std::string units;
    for (const auto& [before, after] :
         {std::pair("\"unit\":\"", '"'), std::pair("<span>", '<'), std::pair("</th><th>", '<')}) {
      const std::string begin = before;
      for (auto at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
        const std::size_t from = at + begin.size();
        units += html.substr(from, html.find(after, from) - from) + "\n";
      }
    }
    EXPECT_THAT(linear_words(units), testing::IsEmpty()) << name;
    EXPECT_THAT(units, HasSubstr("rad")) << name;
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("spoolwatch_rotary_" + std::to_string(getpid()));
  const std::string model = file("servo.toml"), record = file("turning.csv");
};

TEST_F(Rotary, CompareSaysAnglesAndTakesTheRecordAsTheyAre) {
  const std::string text =
      says(add_compare, {model, record, "--all", "--report", file("compare.html")});
  EXPECT_THAT(text, HasSubstr("mrad/s forwards"));
  EXPECT_THAT(text, HasSubstr("turning backwards"));
  EXPECT_THAT(text, Not(HasSubstr("stands for")));
  expect_report_of_angles("compare.html");
}

TEST_F(Rotary, ALengthIsNoAngle) {
  std::ofstream(file("mm.csv"))
      << "Time [s],Command [V],Position [mm]\n0,1,2\n0.01,1,3\n0.02,1,4\n";
  EXPECT_THAT(
      [&] {
        (void)workbench_test::run_command(add_compare, {model, file("mm.csv")});
      },
      testing::ThrowsMessage<config::schema::DataError>(
          testing::AllOf(HasSubstr("mm.csv: has a position in mm, but the model's axis turns"),
                         HasSubstr("--map 'y=Position [mm][rad]'"))));
  std::ofstream(file("m.csv")) << "Time [s],Command [V],Position [m]\n0,1,2\n0.01,1,3\n0.02,1,4\n";
  EXPECT_THAT(
      [&] {
        (void)workbench_test::run_command(add_compare, {model, file("m.csv")});
      },
      testing::ThrowsMessage<config::schema::DataError>(
          HasSubstr("has a position in m, but the model's axis turns")));
}

TEST_F(Rotary, FitSaysAngles) {
  const std::string text =
      says(add_fit, {file("biased.toml"), record, "--quiet", "--profile", "gain_mps_per_V", "-o",
                     file("fitted.toml"), "--report", file("fit.html")});
  EXPECT_THAT(text, HasSubstr("rad/s/V"));
  EXPECT_THAT(linear_words(text_of(file("fitted.toml"))), testing::IsEmpty());
  expect_report_of_angles("fit.html");
}

TEST_F(Rotary, DiagnoseSaysAngles) {
  const std::string text = says(add_diagnose, {model, record, "--quiet", "--report",
                                               file("diagnose.html"), "-o", file("better.toml")});
  EXPECT_THAT(text, HasSubstr("Missing: null_bias"));
  EXPECT_THAT(linear_words(text_of(file("better.toml"))), testing::IsEmpty());
  expect_report_of_angles("diagnose.html");
}

TEST_F(Rotary, IsolateSaysAngles) {
  EXPECT_THAT(says(add_isolate, {file("biased.toml"), record, "--parameters", "gain_mps_per_V",
                                 "--report", file("isolate.html")}),
              HasSubstr("urad"));
  expect_report_of_angles("isolate.html");
}

TEST_F(Rotary, AddShowAndEffectsSayTorques) {
  const std::string axis = file("axis.toml");
  says(add_new, {"rotary-axis", "--motor-inertia-kgcm2", "2.5", "--torque-constant-Nm-per-A", "0.8",
                 "--drive-A-per-V", "1", "-o", axis});
  EXPECT_THAT(says(add_add, {axis, "friction", "coulomb_N=0.01", "-o", file("with.toml")}),
              HasSubstr("coulomb_N = 0.01 N m\n"));
  const std::string sheet = says(add_show, {file("with.toml")});
  EXPECT_THAT(sheet, HasSubstr("more when turning forwards, less when turning backwards"));
  EXPECT_THAT(sheet, HasSubstr("torque per command"));
  EXPECT_THAT(printed_by(add_effects, {axis}), HasSubstr("0 to 1e+06 N m, typically 200: sliding"));
  EXPECT_THAT(printed_by(add_effects, {}), HasSubstr("0 to 1e+06 N, typically 200: sliding"));
}

}  // namespace
}  // namespace workbench::cli
