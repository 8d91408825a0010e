#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/workbench/compare/servo_record.h"
#include "tests/workbench/run_command.h"

namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

const std::string kModel =
    std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/velocity_servo.toml";

class CompareCommand : public testing::Test {
 protected:
  CompareCommand()
      : folder_(fs::path(testing::TempDir()) /
                ("compare_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CompareCommand() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::string written(const config::record::Record& record) const {
    write_csv(record, file("record.csv"));
    return file("record.csv");
  }
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  static std::string text_of(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(name).rdbuf();
    return text.str();
  }

  static int run(std::vector<std::string> arguments) {
    testing::internal::CaptureStdout();
    try {
      const int code =
          workbench_test::run_command(workbench::cli::add_compare, std::move(arguments));
      testing::internal::GetCapturedStdout();
      return code;
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
  }

  /// Exit code and message of a refused start; no file but the record may be left behind.
  void expect_refused(std::vector<std::string> arguments, int code, const std::string& saying) {
    arguments.insert(arguments.end(), {"--json", file("out.json"), "--report", file("out.html")});
    try {
      run(arguments);
      ADD_FAILURE() << "accepted: " << saying;
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), code) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(saying));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("out")));
    }
  }

  nlohmann::json json_of(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--json", file("out.json")});
    EXPECT_EQ(run(arguments), 0);
    return nlohmann::json::parse(text_of(file("out.json")));
  }

  const std::vector<std::string> no_lag_{"--set", "parameters.time_constant_s=0"};

  std::vector<std::string> with_no_lag(const std::string& record) {
    return {kModel, record, no_lag_[0], no_lag_[1]};
  }

  fs::path folder_;
};

double bias(double, double, double) { return 0.002; }

TEST_F(CompareCommand, NotesAChangeThatTheRecordDoesNotReach) {
  const std::string record = written(compare_test::servo_record(bias));
  const std::string model =
      written("changed.toml", text_of(kModel) +
                                  "\n[[change]]\nparameter = \"gain_mps_per_V\"\n"
                                  "factor = 1.1\nat_s = 500.0\n");
  EXPECT_THAT(
      json_of({model, record}).at("notes").dump(),
      testing::AllOf(HasSubstr("the model changes gain_mps_per_V at 500 s, this record ends"),
                     testing::Not(HasSubstr("one record"))));
  EXPECT_THAT(json_of({kModel, record}).at("notes").dump(),
              testing::Not(HasSubstr("the model changes")));
}

TEST_F(CompareCommand, WritesTheFixedKeysInSiUnits) {
  const nlohmann::json out = json_of(with_no_lag(written(compare_test::servo_record(bias))));
  // e = b/l (1 - 0.9 exp(-l t)) from half a second on, when the model that was led at 10 l to a
  // record that begins in motion is left with a tenth: sqrt(1 - 0.9/29.5 + 0.81/4/29.5) b/l
  EXPECT_NEAR(out.at("rms_m").get<double>(), 0.98811e-3, 1e-7);
  EXPECT_NEAR(out.at("free_run_rms_m").get<double>(), 0.06 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(out.at("one_step_rms_m").get<double>(), 1e-5, 1e-9);
  for (const char* key : {"fit_percent", "noise_floor_m", "whiteness_p", "independence_p"}) {
    EXPECT_TRUE(out.at(key).is_number()) << key;
  }
  ASSERT_FALSE(out.at("worst").empty());
  for (const auto& worst : out.at("worst")) {
    EXPECT_TRUE(worst.at("variable").is_string());
    EXPECT_TRUE(worst.at("rms_m").is_number());
    EXPECT_TRUE(worst.contains("from") && worst.contains("to"));
  }
}

TEST_F(CompareCommand, TakesParametersFromTheCommandLine) {
  const std::string record = written(compare_test::servo_record(compare_test::healthy));
  std::vector<std::string> arguments = with_no_lag(record);
  EXPECT_LT(json_of(arguments).at("free_run_rms_m").get<double>(), 1e-9);
  arguments.insert(arguments.end(), {"--set", "parameters.gain_mps_per_V=0.06"});
  EXPECT_GT(json_of(arguments).at("free_run_rms_m").get<double>(), 1e-3);
}

TEST_F(CompareCommand, LooksAtTheAskedPartOnly) {
  std::vector<std::string> arguments = with_no_lag(written(
      compare_test::servo_record([](double t, double, double) { return t < 10.0 ? 0.002 : 0.0; })));
  arguments.insert(arguments.end(), {"--from", "10", "--to", "25"});
  const nlohmann::json out = json_of(arguments);
  EXPECT_EQ(out.at("samples"), 3000);
  EXPECT_LT(out.at("free_run_rms_m").get<double>(), 1e-9);
}

TEST_F(CompareCommand, WritesAReportWithTheCommandThatMadeIt) {
  std::vector<std::string> arguments = with_no_lag(written(compare_test::servo_record(bias)));
  arguments.insert(arguments.end(), {"--report", file("out.html")});
  EXPECT_EQ(run(arguments), 0);
  const std::string page = text_of(file("out.html"));
  EXPECT_THAT(page, HasSubstr("spoolwatch compare"));
  EXPECT_THAT(page, HasSubstr("parameters.time_constant_s=0"));
  EXPECT_THAT(page, HasSubstr("Where it fails"));
}

TEST_F(CompareCommand, RefusesAMissingFile) {
  expect_refused({kModel, file("none.csv")}, 65, "none.csv");
  expect_refused({file("none.toml"), written(compare_test::servo_record(bias))}, 78, "none.toml");
}

TEST_F(CompareCommand, RefusesToWriteOverWhatItReadsOrTwiceToOneFile) {
  const std::string record = written(compare_test::servo_record(bias));
  const std::string text = text_of(record);
  const std::string model = written("servo.toml", text_of(kModel));
  const auto refused = [&](const std::vector<std::string>& outputs, int code) {
    std::vector<std::string> arguments{model, record};
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    try {
      run(arguments);
      ADD_FAILURE() << "accepted: " << outputs[1];
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), code) << error.what();
    }
  };
  refused({"--json", record}, 2);
  refused({"--json", file("./record.csv")}, 2);
  refused({"--report", model}, 2);
  refused({"--json", file("out"), "--report", file("./out")}, 2);
  refused({"--json", file("nowhere/out.json")}, 1);
  refused({"--report", file(".")}, 1);
  EXPECT_EQ(text_of(record), text);
  EXPECT_EQ(text_of(model), text_of(kModel));
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(CompareCommand, RefusesARecordWithoutMotion) {
  config::record::Record record = compare_test::servo_record(compare_test::healthy, 10.0, 2e-6);
  for (std::size_t k = 0; k < record.size(); ++k) record.y_m[k] = k % 3 == 0 ? 0.300005 : 0.3;
  expect_refused({kModel, written(record)}, 65, "does not move");
}

TEST_F(CompareCommand, RefusesARecordThatIsTooShort) {
  expect_refused({kModel, written(compare_test::servo_record(bias, 1.5))}, 65, "too short");
  expect_refused({kModel, written(compare_test::servo_record(bias)), "--from", "29"}, 2, "2 s");
  expect_refused({kModel, written(compare_test::servo_record(bias)), "--from", "9", "--to", "4"}, 2,
                 "--from");
}

TEST_F(CompareCommand, RefusesColumnsWithoutUnits) {
  expect_refused({kModel, written("plain.csv", "t,u,y\n0,0,0\n0.005,1,0.1\n")}, 65, "plain.csv");
}

TEST_F(CompareCommand, NamesTheNearestEffect) {
  const std::string model = written("wrong.toml", text_of(kModel) + "\n[effects.nul_bias]\n");
  expect_refused({model, written(compare_test::servo_record(bias))}, 78, "null_bias");
}

TEST_F(CompareCommand, RefusesAnObserverFasterThanTheSamples) {
  expect_refused({kModel, written(compare_test::servo_record(bias)), "--observer", "200"}, 2,
                 "--observer");
}

TEST_F(CompareCommand, SaysWhatACommandAtItsLimitLeavesUntried) {
  config::record::Record record = compare_test::servo_record(bias);
  double y_m = 0.3;
  for (std::size_t k = 0; k < record.size(); ++k) {
    record.u_V[k] = (k / 200) % 2 == 0 ? 10.0 : -10.0;
    record.y_m[k] = y_m;
    y_m += 0.005 * 0.05 * record.u_V[k];
  }
  EXPECT_THAT(json_of(with_no_lag(written(record))).at("notes"),
              Contains(HasSubstr("+-10 V in 100 %")));
  for (std::size_t k = 0; k < record.size(); ++k) {
    record.u_V[k] = 0.1;
    record.y_m[k] = 0.3 + 0.005 * 0.1 * 0.05 * static_cast<double>(k);
  }
  EXPECT_THAT(json_of(with_no_lag(written(record))).at("notes"),
              Contains(HasSubstr("stays at 0.1 V")));
}

TEST_F(CompareCommand, UsesTheSegmentsOfARecordWithGaps) {
  config::record::Record record = compare_test::servo_record(bias);
  for (auto* column : {&record.t_s, &record.u_V, &record.y_m}) {
    column->erase(column->begin() + 3000, column->begin() + 3100);
  }
  const nlohmann::json out = json_of(with_no_lag(written(record)));
  EXPECT_EQ(out.at("segments"), 2);
  EXPECT_THAT(out.at("notes"), Contains(HasSubstr("2 segments")));
}

}  // namespace
