// Pressures from the inputs that measure them to messages, logs, records, exports and replays.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/record/record.h"
#include "plant_sim/plant.h"
#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using config::record::read_record;
using config::record::Record;
using testing::HasSubstr;

constexpr double kTs_s = 0.005;
constexpr const char* kColumns[] = {"supply_pressure_Pa", "pressure_in_Pa", "pressure_out_Pa"};

using Arguments = std::vector<std::string>;

Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The shipped configuration, recorded in virtual time.
Log make_log(const fs::path& folder, const char* seconds, const Arguments& more = {}) {
  const Result result =
      run(virtual_run(shipped("pressures.toml"), folder) + Arguments{"--duration", seconds} + more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_log(folder);
}

std::string file_of(const fs::path& folder) {
  return fs::directory_iterator(folder)->path().string();
}

Arguments perfect_transducers() {
  Arguments all;
  for (const char* number : {"0", "1", "2"}) {
    for (const char* key : {"offset_Pa", "noise_Pa", "resolution_Pa"}) {
      all = all + Arguments{"--set", std::string("sim.pressure.") + number + "." + key + "=0.0"};
    }
  }
  return all;
}

TEST(Pressures, AreToldBesideEverySampleAsThePlantHasThem) {
  const Folder folder;
  const Log log = make_log(folder.path() / "log", "3", perfect_transducers());
  ASSERT_EQ(log.samples.size(), 601U) << "3 s, and the tick that ends at null";
  ASSERT_EQ(log.pressures.size(), 601U);
  const auto twin =
      plant_sim::make_plant(plant_sim::load_model(shipped("models/thesis_calibrated.toml")));
  for (std::size_t k = 0; k < 601; ++k) {
    const auto& told = log.pressures[k];
    const auto& sample = log.samples[k];
    ASSERT_EQ(told.tick, sample.tick);
    ASSERT_EQ(told.run_id, sample.run_id);
    ASSERT_EQ(told.utc_us, sample.utc_us);
    const config::signals::Pressures wanted = twin->pressures();
    ASSERT_EQ(told.supply_Pa, wanted.supply_Pa) << k;
    ASSERT_EQ(told.in_Pa, wanted.in_Pa) << k;
    ASSERT_EQ(told.out_Pa, wanted.out_Pa) << k;
    twin->advance(sample.u_applied_V, kTs_s);
  }
}

TEST(Pressures, AreNotToldByARigThatMeasuresNone) {
  const Folder folder;
  const Result result =
      run(virtual_run(shipped("thesis_case1.toml"), folder.path() / "log", {"--duration", "1"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log log = read_log(folder.path() / "log");
  EXPECT_EQ(log.samples.size(), 201U);
  EXPECT_TRUE(log.pressures.empty());
  const Record record = read_record(file_of(folder.path() / "log"));
  for (const char* name : kColumns) EXPECT_EQ(record.column(name), nullptr) << name;
}

TEST(Pressures, AreMissingAndNeverOldWhileTheirTransducerIs) {
  const Folder folder;
  const std::string file = folder.path() / "rig.toml";
  std::ifstream in(shipped("pressures.toml"));
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::ofstream(file) << text
                      << "[[sim.trouble]]\nkind = \"missing\"\npressure = \"pressure_in\"\n"
                         "from_s = 0.5\nto_s = 0.6\n[[sim.trouble]]\nkind = \"stale\"\n"
                         "pressure = \"supply_pressure\"\nfrom_s = 0.7\nto_s = 0.8\n";
  const Arguments model = {
      "--set",      "sim.model=" + shipped("models/thesis_calibrated.toml"),
      "--set",      "tracker.0.model=" + shipped("models/thesis_calibrated.toml"),
      "--duration", "1"};
  const Result result = run(virtual_run(file, folder.path() / "log") + model);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log log = read_log(folder.path() / "log");
  ASSERT_EQ(log.pressures.size(), 201U);
  for (std::size_t k = 0; k < 200; ++k) {
    EXPECT_EQ(std::isnan(log.pressures[k].in_Pa), k >= 100 && k < 120) << k;
    EXPECT_EQ(std::isnan(log.pressures[k].supply_Pa), k >= 140 && k < 160) << k;
    EXPECT_FALSE(std::isnan(log.pressures[k].out_Pa)) << k;
    EXPECT_EQ(log.samples[k].state, 3) << "the loop needs none of them";
  }
}

/// Columns of `record` against the messages of the same ticks.
void expect_columns(const Record& record, const Log& log, const std::string& what) {
  ASSERT_EQ(record.size(), log.samples.size()) << what;
  for (const char* name : kColumns) ASSERT_NE(record.column(name), nullptr) << what << name;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const auto& told = log.pressures[k];
    const double wanted_Pa[] = {told.supply_Pa, told.in_Pa, told.out_Pa};
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_TRUE(same(record.column(kColumns[i])->at(k), wanted_Pa[i])) << what << k;
    }
  }
}

TEST(Pressures, ComeOutAsColumnsOfARecordHoweverItIsMade) {
  const Folder folder;
  const Log log = make_log(folder.path() / "log", "3");
  const std::string file = file_of(folder.path() / "log");
  expect_columns(read_record(file), log, "log ");
  const std::string at = folder.path() / "out";
  for (const std::string ending : {".csv", ".mat"}) {
    const Result exported = spoolwatch("export " + file + " -o " + at + ending);
    ASSERT_EQ(exported.exit_code, 0) << exported.out;
    expect_columns(read_record(at + ending), log, ending);
  }
  const Result recorded =
      spoolwatch("record -o " + at + "2.csv --lcm-url 'file://" + file + "?mode=r&speed=0'");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.out;
  expect_columns(read_record(at + "2.csv"), log, "record ");
  ASSERT_EQ(spoolwatch("export " + file + " -o " + at + ".json --channel pressures").exit_code, 0);
  std::ifstream lines(at + ".json");
  std::size_t k = 0;
  for (std::string line; std::getline(lines, line); ++k) {
    const auto json = nlohmann::json::parse(line);
    ASSERT_EQ(json.at("pressures").at("pressure_in_Pa"), log.pressures.at(k).in_Pa) << line;
    ASSERT_EQ(json.at("pressures").at("tick"), log.samples.at(k).tick) << line;
  }
  EXPECT_EQ(k, log.samples.size());
  // One table has no place for them but as columns.
  const Result refused = spoolwatch("export " + file + " -o " + at + ".csv --channel pressures");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.out, HasSubstr("--channel pressures: is among the columns of sample"));
  ASSERT_EQ(spoolwatch("export " + file + " -o " + at + ".mcap").exit_code, 0);
  std::ifstream mcap(at + ".mcap", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(mcap), {});
  EXPECT_THAT(bytes, HasSubstr("/pressures"));
}

TEST(Pressures, OfARecordAreReadAgainByTheReplayBackend) {
  const Folder folder;
  const Log log = make_log(folder.path() / "log", "3");
  const std::string csv = folder.path() / "r.csv";
  ASSERT_EQ(spoolwatch("export " + file_of(folder.path() / "log") + " -o " + csv).exit_code, 0);
  const std::string rig = folder.path() / "replay.toml";
  std::string text =
      "schema_version = 1\n[rod]\nbackend = \"replay\"\n[valve]\nbackend = "
      "\"none\"\n[replay]\npace = \"fast\"\nrecord = \"" +
      csv + "\"\n";
  for (const char* name : {"supply_pressure", "pressure_in", "pressure_out"}) {
    text += std::string("[[input]]\nid = \"") + name + "\"\nrole = \"" + name +
            "\"\nbackend = \"replay\"\nchannel = \"" + name + "\"\n";
  }
  std::ofstream(rig) << text;
  const Result result = run(virtual_run(rig, folder.path() / "again"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log again = read_log(folder.path() / "again");
  ASSERT_EQ(again.samples.size(), log.samples.size());
  ASSERT_EQ(again.pressures.size(), log.pressures.size());
  for (std::size_t k = 0; k < log.samples.size(); ++k) {
    ASSERT_EQ(again.samples[k].y_m, log.samples[k].y_m);
    ASSERT_EQ(again.pressures[k].supply_Pa, log.pressures[k].supply_Pa);
    ASSERT_EQ(again.pressures[k].in_Pa, log.pressures[k].in_Pa);
    ASSERT_EQ(again.pressures[k].out_Pa, log.pressures[k].out_Pa);
  }
}

TEST(Pressures, AreListedByCheckAndStandOnce) {
  const Result listed = run({"--config", shipped("pressures.toml"), "--check"});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out,
              HasSubstr("\n# Pressures with every sample: supply_pressure from sim "
                        "\"supply_pressure\", pressure_in from sim \"pressure_in\", pressure_out "
                        "from sim \"pressure_out\".\n"));
  const Result twice =
      run({"--config", shipped("pressures.toml"), "--check", "--set", "input.2.role=pressure_in"});
  EXPECT_EQ(twice.exit_code, 78);
  EXPECT_THAT(twice.err, HasSubstr("[[input]] 3 role: is \"pressure_in\", and so is that of "
                                   "\"chamber_in\"; allowed: one input of that role"));
  EXPECT_EQ(std::count(twice.err.begin(), twice.err.end(), '\n'), 1) << twice.err;
}

}  // namespace
}  // namespace program
