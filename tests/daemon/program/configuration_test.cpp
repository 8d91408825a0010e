// Every bad configuration is one line that says file, table, key and what is allowed, exit 78,
// before anything is written anywhere.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

constexpr const char* kHealthy = R"(schema_version = 1
[loop]
rate_hz = 200.0
auto_arm = true
[rod]
backend = "sim"
[valve]
backend = "sim"
[sim]
model = "MODELS/thesis_calibrated.toml"
[reference]
kind = "sine"
[controller]
kp_V_per_m = 250.0
[[estimator]]
id = "period"
window_s = 2.0
[[band]]
id = "pressure"
quantity = "period.b1"
high = 2.1e-4
)";

struct Case {
  const char* what;
  const char* replace;  ///< this text of kHealthy
  const char* by;       ///< gives way to this one
  const char* place;    ///< both must be named in the message
  const char* allowed;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.what; }

class BadConfiguration : public testing::TestWithParam<Case> {};

/// Writes kHealthy with one change to FOLDER/rig.toml.
std::string write_config(const Folder& folder, const std::string& from, const std::string& to) {
  std::string text = kHealthy;
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  if (const auto models = text.find("MODELS"); models != std::string::npos) {
    text.replace(models, 6, shipped("models"));
  }
  std::string file = (folder.path() / "rig.toml").string();
  std::ofstream(file) << text;
  return file;
}

TEST_P(BadConfiguration, IsRefusedInOneLineThatSaysWhereAndWhatIsAllowed) {
  const Folder folder;
  const std::string file = write_config(folder, GetParam().replace, GetParam().by);
  const Result result = run(virtual_run(file, folder.path() / "log", {"--duration", "1"}));
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("rig.toml"));
  EXPECT_THAT(result.err, HasSubstr(GetParam().place));
  EXPECT_THAT(result.err, HasSubstr(GetParam().allowed));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "log")) << "it ran before it refused";
  EXPECT_EQ(run({"--config", file, "--check"}).exit_code, 78) << "--check accepts it";
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadConfiguration,
    testing::Values(
        Case{"no_toml", "[loop]", "[loop", "rig.toml:2", ""},
        Case{"other_schema", "schema_version = 1", "schema_version = 9", "schema_version",
             "1 to 1"},
        Case{"unknown_table", "[loop]", "[lop]", "lop", "loop"},
        Case{"unknown_key", "auto_arm", "auto_arn", "[loop] auto_arn", "auto_arm"},
        Case{"wrong_type", "rate_hz = 200.0", "rate_hz = \"fast\"", "[loop] rate_hz", "a number"},
        Case{"out_of_range", "rate_hz = 200.0", "rate_hz = -1", "[loop] rate_hz", "1 to 2000"},
        Case{"not_a_number", "kp_V_per_m = 250.0", "kp_V_per_m = nan", "[controller] kp_V_per_m",
             "0 to"},
        Case{"period_against_model", "rate_hz = 200.0", "rate_hz = 300.0", "[loop] rate_hz",
             "whole number of steps"},
        Case{"unknown_privilege", "auto_arm = true", "privileges = \"maybe\"", "[loop] privileges",
             "require, try, off"},
        Case{"unknown_backend", "backend = \"sim\"", "backend = \"modem\"", "[rod] backend",
             "sim, replay"},
        Case{"missing_backend", "backend = \"sim\"", "", "[rod] backend", "allowed"},
        Case{"model_not_there", "thesis_calibrated.toml", "nothing.toml", "[sim] model",
             "a model file"},
        Case{"model_missing", "model = ", "#", "[sim] model", "model file"},
        Case{"key_of_an_unused_backend", "[reference]", "[replay]\nrecord = \"x\"\n[reference]",
             "replay", "allowed"},
        Case{"unknown_motion", "kind = \"sine\"", "kind = \"square\"", "[reference] kind", "prbs"},
        Case{"motion_file_not_there", "kind = \"sine\"", "kind = \"file\"\nfile = \"none.csv\"",
             "[reference] file", "a CSV file"},
        Case{"motion_without_frequencies", "kind = \"sine\"",
             "kind = \"multisine\"\nfrequencies_Hz = []", "[reference]: frequencies_Hz: is empty",
             "one at least"},
        Case{"motion_of_equal_frequencies", "kind = \"sine\"",
             "kind = \"multisine\"\nfrequencies_Hz = [1.0, 2.0, 1.0]",
             "[reference]: frequencies_Hz: names", "different"},
        Case{"null_beyond_the_converter", "[sim]", "null_V = -10.5\n[sim]", "[valve] null_V",
             "dac_range_V"},
        Case{"unknown_structure", "window_s", "structure = \"arx\"\nwindow_s",
             "[[estimator]] period: structure", "arxNMK"},
        Case{"unknown_quantity", "period.b1", "perio.b1", "[[band]] pressure: quantity",
             "sample, period"},
        Case{"fault_of_nothing", "[reference]",
             "[[sim.fault]]\nparameter = \"oil\"\nat_s = 1.0\nfactor = 2.0\n[reference]", "oil",
             ""},
        Case{"guard_without_a_kind", "[reference]", "[[guard]]\naction = \"hold\"\n[reference]",
             "[guard.0] kind", "kind of guard"},
        Case{"guard_of_nothing", "[reference]", "[[guard]]\nkind = \"mood\"\n[reference]", "kind",
             "travel"},
        Case{"guard_without_its_limit", "[reference]", "[[guard]]\nkind = \"speed\"\n[reference]",
             "limit_mps", ""},
        Case{"hold_on_a_sensor_that_lies", "[reference]",
             "[[guard]]\nkind = \"frozen\"\naction = \"hold\"\n[reference]", "action",
             "indicate, ramp, latch"},
        Case{"travel_upside_down", "[reference]",
             "[[guard]]\nkind = \"travel\"\nlow_m = 0.4\nhigh_m = 0.2\n[reference]", "high_m",
             "0.4"},
        Case{"two_guards_of_one_name", "[reference]",
             "[[guard]]\nkind = \"travel\"\n[[guard]]\nkind = \"travel\"\n[reference]",
             "[[guard]] id: \"travel\" is listed twice", "unique ids"},
        Case{"real_without_a_watchdog", "[reference]", "pretend_real = true\n[reference]",
             "[valve] backend", "accept_no_hardware_watchdog = true"},
        Case{"real_that_arms_itself", "[reference]",
             "pretend_real = true\ncommand_timeout_s = 0.1\n[reference]", "[loop] auto_arm",
             "false"},
        Case{"socket_of_no_group", "[reference]",
             "[control]\ngroup = \"nobody-knows-this\"\n[reference]", "[control] group",
             "a group on this machine"},
        Case{"bands_not_there", "schema_version = 1",
             "schema_version = 1\nbands_file = \"no.toml\"", "bands_file", "learned bands"}),
    [](const auto& test) { return std::string(test.param.what); });

TEST(Configuration, TheCaseThatTheTableStartsFromIsHealthy) {
  const Folder folder;
  const std::string file = write_config(folder, "", "");
  EXPECT_EQ(run({"--config", file, "--check"}).exit_code, 0);
  const Result result = run(virtual_run(file, folder.path() / "log", {"--duration", "1"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Configuration, MissingFileIsOneLineAnd78) {
  const Result result = run({"--config", "/no/such/file.toml"});
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(result.err, HasSubstr("/no/such/file.toml"));
}

TEST(Configuration, BadUsageIsExitCode2) {
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({"--config"}).exit_code, 2);
  EXPECT_EQ(run({"--config", "a", "--clock", "sundial"}).exit_code, 2);
  EXPECT_EQ(run({"--config", "a", "--duration", "-3"}).exit_code, 2);
  for (const char* duration : {"0", "nan", "inf", "1e300", "1e-300"}) {
    const Result result = run({"--config", shipped("demo.toml"), "--clock", "virtual", "--lcm-url",
                               "", "--duration", duration});
    EXPECT_EQ(result.exit_code, 2) << duration;
    EXPECT_THAT(result.err, HasSubstr(std::string("--duration: is ") + duration + "; allowed"));
  }
  EXPECT_EQ(run({"--config", "a", "--no-such-flag"}).exit_code, 2);
  EXPECT_EQ(run({"--config", shipped("demo.toml"), "--set", "nonsense"}).exit_code, 2);
  EXPECT_EQ(run({"--help"}).exit_code, 0);
}

TEST(Configuration, SetChangesOneValueAndIsCheckedLikeTheFile) {
  const Result changed =
      run({"--config", shipped("demo.toml"), "--set", "controller.kp_V_per_m=123.5", "--check"});
  EXPECT_EQ(changed.exit_code, 0) << changed.err;
  EXPECT_THAT(changed.out, HasSubstr("kp_V_per_m = 123.5"));
  const Result refused =
      run({"--config", shipped("demo.toml"), "--set", "controller.kp_V_per_m=much", "--check"});
  EXPECT_EQ(refused.exit_code, 78);
  EXPECT_THAT(refused.err, HasSubstr("[controller] kp_V_per_m"));
}

TEST(Configuration, CheckPrintsATomlThatGivesTheSameAgainAndTheWayToNull) {
  const Folder folder;
  for (const char* name : {"demo.toml", "spoolwatchd.toml", "thesis_case1.toml",
                           "thesis_case2.toml", "thesis_case3.toml"}) {
    const Result first = run({"--config", shipped(name), "--check"});
    ASSERT_EQ(first.exit_code, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("worst time (ms)"));
    const std::string file = (folder.path() / "again.toml").string();
    std::ofstream(file) << first.out;
    const Result again = run({"--config", file, "--set",
                              "sim.model=" + shipped("models/thesis_calibrated.toml"), "--check"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const auto controller = first.out.find("[reference]");
    const auto end = first.out.find("\n# ");
    EXPECT_THAT(again.out, HasSubstr(first.out.substr(controller, end - controller)));
  }
}

TEST(Configuration, CheckRefusesWhatAStartWouldRefuse) {
  const Result url = run({"--config", shipped("demo.toml"), "--lcm-url", "nonsense", "--check"});
  EXPECT_EQ(url.exit_code, 78);
  EXPECT_THAT(url.err, HasSubstr("LCM URL \"nonsense\""));
  const Result folder = run({"--config", shipped("demo.toml"), "--lcm-url", "", "--set",
                             "recorder.folder=/dev/null/log", "--check"});
  EXPECT_EQ(folder.exit_code, 78);
  EXPECT_THAT(folder.err, HasSubstr("/dev/null is not a folder"));
}

TEST(Configuration, CheckPrintsTheWayToNullAlsoWhereADeviceCannotBeReached) {
  const Result modbus = run(
      {"--config", shipped("bench_modbus.toml"), "--check", "--set", "modbus.address=127.0.0.1:9"});
  EXPECT_EQ(modbus.exit_code, 78);
  // Two periods of 5 ms, 0.1 ms for the thread, 0.5 ms declared; 0.45 m/s.
  EXPECT_THAT(modbus.out, ContainsRegex("stop, signal or error +modbus +10\\.6 +4\\.77\n"));
  EXPECT_THAT(modbus.out, ContainsRegex("process killed +modbus +50\\.0 +22\\.50\n"));
  EXPECT_THAT(modbus.err, HasSubstr("[modbus] address \"127.0.0.1:9\": cannot be connected"));
  EXPECT_EQ(std::count(modbus.err.begin(), modbus.err.end(), '\n'), 1) << modbus.err;
  const Result stand = run({"--config", shipped("stand_gpio_comedi.toml"), "--check", "--set",
                            "encoder.chip=gpiochip77"});
  EXPECT_EQ(stand.exit_code, 78);
  EXPECT_THAT(stand.out, ContainsRegex("process killed +comedi +never"));
  EXPECT_THAT(stand.err, HasSubstr("[encoder] chip: is \"gpiochip77\""));
  EXPECT_EQ(std::count(stand.err.begin(), stand.err.end(), '\n'), 1) << stand.err;
}

TEST(Configuration, ARealRigWithAWatchdogOfSomeKindIsAccepted) {
  const Folder folder;
  for (const char* watchdog : {"accept_no_hardware_watchdog = true\n[sim]\npretend_real = true\n",
                               "[permit]\nbackend = \"sim\"\n[sim]\npretend_real = true\n",
                               "[sim]\npretend_real = true\ncommand_timeout_s = 0.1\n"}) {
    const std::string file = write_config(folder, "[sim]\n", watchdog);
    const Result result = run({"--config", file, "--set", "loop.auto_arm=false", "--check"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("It cannot be armed: no [rig] calibration"));
    EXPECT_THAT(result.out, HasSubstr("process killed"));
  }
}

TEST(Configuration, ALogFolderStartsFromTheFileLikeEveryOtherPath) {
  const Folder folder;
  const std::string file =
      write_config(folder, "[reference]", "[recorder]\nfolder = \"logs\"\n[reference]");
  const Result result =
      run({"--config", file, "--clock", "virtual", "--lcm-url", "", "--duration", "0.1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "logs"));
}

TEST(Configuration, CheckOfAReplayNeedsItsRecordAndWritesNothing) {
  const Result missing = run({"--config", shipped("replay.toml"), "--check"});
  EXPECT_EQ(missing.exit_code, 78);
  EXPECT_THAT(missing.err, HasSubstr("[replay] record"));
  const Folder folder;
  std::ofstream(folder.path() / "bad.csv") << "t_s,u_V,y_m\n0,1,2\n1,x,3\n";
  const Result bad = run({"--config", shipped("replay.toml"), "--set",
                          "replay.record=" + (folder.path() / "bad.csv").string(), "--check"});
  EXPECT_EQ(bad.exit_code, 65) << bad.err;
}

}  // namespace
}  // namespace program
