// The command: what it writes, and what it refuses.
#include <gmock/gmock.h>

#include <CLI/Error.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "estimator/fdi/tracker/baseline_file.h"
#include "tests/estimator/greybox/tracking/tracked_rig.h"
#include "tests/truth/case.h"
#include "tests/workbench/run_command.h"

namespace tracker = estimator::fdi::tracker;
namespace tracking = estimator::greybox::tracking;

namespace {

using namespace tracking_test;
using workbench_test::run_command;
namespace fs = std::filesystem;

class IsolateCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("isolate_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "model.toml") << plant_sim::print_model(printed_model());
    truth::Case of = stand(22.0);
    fault(of, 15.0, &truth::Plant::supply_pressure_Pa, 0.9);
    truth::write_csv(truth::simulate(of), file("record.csv"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void run(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{file("model.toml"), file("record.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_command(workbench::cli::add_isolate, arguments);
  }
  int code(const std::vector<std::string>& more, std::string& line) const {
    try {
      run(more);
    } catch (const config::schema::Error& error) {
      line = error.what();
      return config::schema::exit_code_of(error);
    }
    return 0;
  }

  fs::path folder_;
};

TEST_F(IsolateCommand, WritesWindowsAndAlarmsAsJsonAndAPage) {
  run({"--json", file("out.json"), "--report", file("out.html")});
  const auto json = nlohmann::json::parse(std::ifstream(file("out.json")));
  ASSERT_EQ(json["windows"].size(), 39u);  // from 2.75 s every 0.5 s up to 22 s
  const auto& last = json["windows"].back();
  EXPECT_TRUE(last["valid"]);
  EXPECT_EQ(last["why"], "");
  EXPECT_NEAR(last["t_s"].get<double>(), 21.745, 1e-6);
  const double pressure_Pa = last["supply_pressure_Pa"]["value"];
  EXPECT_NEAR(pressure_Pa, 0.9 * 6.89e6, 0.002 * 6.89e6);
  EXPECT_GT(last["supply_pressure_Pa"]["std_error"], 0.0);
  EXPECT_NEAR(last["damping_N_s_per_m"]["value"].get<double>(), 1000.0, 40.0);
  ASSERT_EQ(json["alarms"].size(), 1u);
  const auto& alarm = json["alarms"][0];
  EXPECT_EQ(alarm["parameter"], "supply_pressure_Pa");
  EXPECT_EQ(alarm["direction"], "low");
  EXPECT_NEAR(alarm["change_ratio"].get<double>(), -0.1, 0.002);
  EXPECT_GT(alarm["confidence"], 0.99);
  EXPECT_TRUE(alarm["cleared_s"].is_null());
  EXPECT_EQ(alarm["ambiguity_group"][0], "supply_pressure_Pa");
  EXPECT_THAT(alarm["advice"].get<std::string>(), testing::HasSubstr("supply pressure"));
  EXPECT_GT(fs::file_size(file("out.html")), 10000u);
}

TEST_F(IsolateCommand, WritesWhatIsHealthyForTheDaemon) {
  run({"--learn", file("healthy.toml"), "--rig", "stand-1"});
  const plant_sim::ModelFile model = plant_sim::load_model(file("model.toml"));
  const tracking::ParameterSet set = tracking::choose(model, usual(), "parameters");
  const auto learnt =
      tracker::read_baseline(file("healthy.toml"), model, {}, set, truth::kSample_s, "stand-1");
  EXPECT_NEAR(learnt.values[0], 6.89e6, 0.002 * 6.89e6);
  EXPECT_NEAR(learnt.values[1], 1000.0, 20.0);
  EXPECT_NEAR(learnt.rms_m, kFloor_m, 0.1 * kFloor_m);
  std::string line;
  EXPECT_EQ(code({"--learn", file("healthy.toml"), "--healthy-rms", "2e-6"}, line), 2);
}

TEST_F(IsolateCommand, LearnsWhatIsHealthyFromARecordOfItsOwn) {
  truth::write_csv(truth::simulate(stand(12.0)), file("healthy.csv"));
  truth::Case faulty = stand(12.0);
  fault(faulty, 0.0, &truth::Plant::supply_pressure_Pa, 0.9);
  truth::write_csv(truth::simulate(faulty), file("record.csv"));
  run({"--healthy-record", file("healthy.csv"), "--json", file("out.json")});
  std::ifstream in(file("out.json"));
  const auto json = nlohmann::json::parse(in);
  ASSERT_EQ(json["alarms"].size(), 1U);
  EXPECT_EQ(json["alarms"][0]["parameter"], "supply_pressure_Pa");
  EXPECT_NEAR(json["alarms"][0]["change_ratio"].get<double>(), -0.1, 0.02);
  std::string line;
  EXPECT_THROW(code({"--healthy-record", file("healthy.csv"), "--healthy", "0:5"}, line),
               CLI::ExcludesError);
  EXPECT_EQ(code({"--healthy", "0:1"}, line), 65);
  EXPECT_THAT(line, testing::HasSubstr("--healthy-record"));
}

TEST_F(IsolateCommand, TellsInWords) {
  testing::internal::CaptureStdout();
  run({});
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_THAT(text, testing::HasSubstr("supply pressure low, -10.0 %"));
  EXPECT_THAT(text, testing::HasSubstr("or valve gain"));
  EXPECT_THAT(text, testing::HasSubstr("invalid"));
}

TEST_F(IsolateCommand, UsesTheChamberPressuresOfTheRecord) {
  truth::Case of = stand(22.0);
  of.pressure_noise_Pa = 5e3;
  fault(of, 15.0, &truth::Plant::valve_gain_m_per_V, 0.9);
  truth::Record record = truth::simulate(of);
  truth::write_csv(record, file("record.csv"));
  // without the supply's column
  std::ifstream all(file("record.csv"));
  std::ofstream two(file("two.csv"));
  for (std::string line; std::getline(all, line);) {
    std::size_t at = 0;
    for (int comma = 0; comma < 3; ++comma) at = line.find(',', at) + 1;
    two << line.erase(at, line.find(',', at) + 1 - at) << '\n';
  }
  two.close();
  fs::rename(file("two.csv"), file("record.csv"));
  run({"--json", file("out.json"), "--learn", file("healthy.toml")});
  const auto json = nlohmann::json::parse(std::ifstream(file("out.json")));
  ASSERT_EQ(json["alarms"].size(), 1u) << json["alarms"].dump(1);
  EXPECT_EQ(json["alarms"][0]["parameter"], "valve_gain_m_per_V");
  EXPECT_TRUE(json["alarms"][0]["ambiguity_group"].empty());
  EXPECT_EQ(json["alarms"][0]["advice"], "");
  EXPECT_EQ(json["parameters"].size(), 3u);
  EXPECT_EQ(json["notes"].back(),
            "the record's pressure_in_Pa and pressure_out_Pa are fitted beside the position");
  // 2000 readings of healthy windows
  EXPECT_NEAR(json["healthy"]["pressures"]["in_error_Pa"].get<double>(), 5e3, 300.0);
  EXPECT_NEAR(json["windows"].back()["pressures"]["out_error_Pa"].get<double>(), 5e3, 1000.0);
  const plant_sim::ModelFile model = plant_sim::load_model(file("model.toml"));
  const tracking::ParameterSet set = tracking::choose(
      model, {"supply_pressure_Pa,damping_N_s_per_m,valve_gain_m_per_V"}, "parameters");
  const auto learnt =
      tracker::read_baseline(file("healthy.toml"), model, {}, set, truth::kSample_s, "");
  EXPECT_TRUE(learnt.chambers.known());

  run({"--json", file("out.json"), "--no-pressures"});
  const auto without = nlohmann::json::parse(std::ifstream(file("out.json")));
  ASSERT_EQ(without["alarms"].size(), 1u);
  EXPECT_THAT(without["alarms"][0]["ambiguity_group"].get<std::vector<std::string>>(),
              testing::ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V"));
  EXPECT_FALSE(without["healthy"].contains("pressures"));
}

TEST_F(IsolateCommand, SaysWhyWindowsAreByPositionAlone) {
  truth::Case of = stand(22.0);
  of.pressure_noise_Pa = 5e3;
  truth::Record record = truth::simulate(of);
  for (std::size_t k = 3000; k < record.in_Pa.size(); ++k) record.out_Pa[k] = record.out_Pa[3000];
  truth::write_csv(record, file("record.csv"));
  testing::internal::CaptureStdout();
  run({});
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_THAT(text, testing::HasSubstr("no change named"));
  EXPECT_THAT(text, testing::HasSubstr("windows by position alone"));
  EXPECT_THAT(text, testing::HasSubstr("the reading of the pressure out stands still"));
}

TEST_F(IsolateCommand, SuspectsThePositionSensorWhereItIsAskedTo) {
  truth::Case of = stand(22.0);
  fault(of, 15.0, &truth::Plant::valve_gain_m_per_V, 1.05);
  truth::write_csv(truth::simulate(of), file("record.csv"));
  const auto group = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--json", file("out.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(arguments);
    const auto json = nlohmann::json::parse(std::ifstream(file("out.json")));
    return json["alarms"][0]["ambiguity_group"].get<std::vector<std::string>>();
  };
  EXPECT_THAT(group({}), testing::ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V"));
  EXPECT_THAT(group({"--suspect-position-sensor"}),
              testing::ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V",
                                   "position_sensor.scale_ratio"));
}

TEST_F(IsolateCommand, FollowsWhatMayChangeSlowly) {
  truth::Case of = stand(130.0);
  for (int k = 0; k < 100; ++k) {  // by 5 % in 100 s
    fault(of, 15.0 + k, &truth::Plant::damping_N_s_per_m, 1.0 - 0.0005 * (k + 1));
  }
  truth::write_csv(truth::simulate(of), file("record.csv"));
  const auto found = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--json", file("out.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(arguments);
    return nlohmann::json::parse(std::ifstream(file("out.json")));
  };
  EXPECT_EQ(found({})["alarms"].size(), 1u);
  const auto json = found({"--follow", "damping_N_s_per_m", "--follow-per-hour", "3"});
  EXPECT_EQ(json["alarms"].size(), 0u);
  EXPECT_THAT(json["notes"].back().get<std::string>(), testing::StartsWith("damping was followed"));
}

TEST_F(IsolateCommand, NamesAChangeUnderProcessDisturbance) {
  truth::Case of = stand(50.0, 9301);
  of.outside.force_N = 30.0;
  of.outside.pulsation_Pa = 1e5;
  fault(of, 42.0, &truth::Plant::supply_pressure_Pa, 0.9);
  truth::write_csv(truth::simulate(of), file("record.csv"));
  run({"--healthy", "0:40", "--json", file("out.json"), "--learn", file("healthy.toml")});
  const auto json = nlohmann::json::parse(std::ifstream(file("out.json")));
  ASSERT_EQ(json["alarms"].size(), 1u) << json["alarms"].dump(1);
  EXPECT_EQ(json["alarms"][0]["parameter"], "supply_pressure_Pa");
  EXPECT_LT(json["alarms"][0]["raised_s"], 44.0);
  const auto& disturbance = json["healthy"]["disturbance"];
  EXPECT_EQ(disturbance["as"], "force");
  EXPECT_NEAR(disturbance["value"].get<double>(), 30.0, 0.3 * 30.0);
  EXPECT_EQ(disturbance["lines"][0]["as"], "pressure");
  EXPECT_NEAR(disturbance["lines"][0]["frequency_Hz"].get<double>(), 23.0, 0.1);
  EXPECT_GT(json["healthy"]["std_errors"]["damping_N_s_per_m"], 10.0);
  EXPECT_TRUE(json["windows"].back().contains("disturbance"));
  const plant_sim::ModelFile model = plant_sim::load_model(file("model.toml"));
  const tracking::ParameterSet set = tracking::choose(model, usual(), "parameters");
  const auto learnt =
      tracker::read_baseline(file("healthy.toml"), model, {}, set, truth::kSample_s, "");
  ASSERT_TRUE(learnt.noise.has_value());
  EXPECT_EQ(learnt.noise->covariance.rows(), 2);
  testing::internal::CaptureStdout();
  run({"--healthy", "0:40"});
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_THAT(text, testing::HasSubstr("disturbed: random force "));
  EXPECT_THAT(text, testing::HasSubstr("pressure line at 23.0"));
  EXPECT_THAT(text, testing::HasSubstr("supply pressure low"));
}

TEST_F(IsolateCommand, RefusesWhatItCannotUse) {
  std::string line;
  EXPECT_EQ(code({"--follow", "mass_kg"}, line), 78);
  EXPECT_THAT(line, testing::HasSubstr("--follow: names mass_kg, which is not tracked"));
  EXPECT_EQ(code({"--parameters", "supply_pressur_Pa"}, line), 78);
  EXPECT_THAT(line, testing::HasSubstr("--parameters supply_pressur_Pa"));
  EXPECT_THAT(line, testing::HasSubstr("did you mean supply_pressure_Pa"));
  EXPECT_EQ(code({"--healthy", "ten"}, line), 2);
  EXPECT_EQ(code({"--healthy", "0:1"}, line), 65);
  EXPECT_THAT(line, testing::HasSubstr("has no whole window"));
  EXPECT_EQ(code({"--window", "50"}, line), 65);
  EXPECT_THAT(line, testing::HasSubstr("is too short"));
  EXPECT_EQ(code({"--observer", "500"}, line), 2);
}

}  // namespace
