#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/Error.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/workbench/run_command.h"

namespace workbench::estimate {
namespace {

using config::record::Record;
using nlohmann::json;

/// y(t) = 1.5 y(t-1) - 0.6 y(t-2) + 2e-4 u(t-1) + 1e-3, so a = -1.5, 0.6 and b = 2e-4.
Record known(int samples) {
  Record record;
  double y1 = 0.0, y2 = 0.0, u1 = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double y = 1.5 * y1 - 0.6 * y2 + 2e-4 * u1 + 1e-3;
    const double u = std::sin(0.1 * i) + std::sin(0.037 * i * i);
    record.t_s.push_back(0.005 * i);
    record.u_V.push_back(u);
    record.y_m.push_back(y);
    y2 = y1;
    y1 = y;
    u1 = u;
  }
  return record;
}

class Estimate : public testing::Test {
 protected:
  Estimate() { std::filesystem::create_directories(folder_); }
  ~Estimate() override { std::filesystem::remove_all(folder_); }

  json run(const Record& record, std::vector<std::string> arguments) {
    config::record::write_csv(record, folder_ / "record.csv");
    return run_file(folder_ / "record.csv", std::move(arguments));
  }
  json run_file(const std::filesystem::path& file, std::vector<std::string> arguments) {
    const std::string out = folder_ / "out.json";
    arguments.insert(arguments.begin(), {file.string(), "--json", out});
    EXPECT_EQ(workbench_test::run_command(workbench::cli::add_estimate, arguments), 0);
    std::ifstream in(out);
    return json::parse(in);
  }

  std::filesystem::path folder_ =
      testing::TempDir() + "/spoolwatch_estimate_" + std::to_string(getpid());
};

void expect_known(const json& found) {
  EXPECT_NEAR(found["a"][0], -1.5, 1e-9);
  EXPECT_NEAR(found["a"][1], 0.6, 1e-9);
  EXPECT_NEAR(found["b"][0], 2e-4, 1e-12);
  EXPECT_NEAR(found["constant"], 1e-3, 1e-10);
}

TEST_F(Estimate, FindsKnownCoefficientsAndWritesTheAgreedKeys) {
  const json out = run(known(400), {"--structure", "arx211", "--constant"});
  expect_known(out);
  EXPECT_EQ(out["structure"], "arx211");
  EXPECT_EQ(out["method"], "batch");
  EXPECT_EQ(out["std_error"]["a"].size(), 2U);
  EXPECT_EQ(out["std_error"]["b"].size(), 1U);
  EXPECT_GT(out["condition"].get<double>(), 1.0);
  EXPECT_LT(out["cost_m2"].get<double>(), 1e-18);
  EXPECT_LT(out["one_step_rms_m"].get<double>(), 1e-12);
  EXPECT_LT(out["free_run_rms_m"].get<double>(), 1e-9);
  EXPECT_TRUE(out["windows"].empty());
  EXPECT_TRUE(out["valid"]);
}

TEST_F(Estimate, GivesANullConstantWithoutOne) {
  EXPECT_TRUE(run(known(100), {"--structure", "arx211"})["constant"].is_null());
}

TEST_F(Estimate, GivesOneEstimateForEachWindow) {
  const json batch = run(known(400), {"--structure", "arx211", "--constant", "--window", "0.5"});
  ASSERT_EQ(batch["windows"].size(), 4U);
  for (const json& window : batch["windows"]) expect_known(window);
  EXPECT_NEAR(batch["windows"][1]["from_s"], 0.5, 1e-12);
  EXPECT_NEAR(batch["windows"][1]["to_s"], 0.995, 1e-12);

  const json sliding = run(known(400), {"--structure", "arx211", "--constant", "--method",
                                        "sliding", "--window", "0.5", "--stride", "0.1"});
  ASSERT_EQ(sliding["windows"].size(), 16U);  // ends at 0.5, 0.6, ... 2.0 s
  for (const json& window : sliding["windows"]) expect_known(window);

  const json recursive =
      run(known(4000), {"--structure", "arx211", "--constant", "--method", "recursive", "--stride",
                        "1", "--prior-variance", "1e12"});
  ASSERT_EQ(recursive["windows"].size(), 20U);
  EXPECT_NEAR(recursive["a"][0], -1.5, 1e-6);
}

TEST_F(Estimate, ScoresTheFreeRunOnThePartThatWasNotFitted) {
  Record record = known(400);
  for (std::size_t i = 200; i < 400; ++i) record.y_m[i] += 0.01;  // another rest position
  const json out = run(record, {"--structure", "arx211", "--constant", "--fit", "first-half"});
  expect_known(out);
  EXPECT_NEAR(out["scored_from_s"], 1.0, 1e-12);
  EXPECT_GT(out["free_run_rms_m"].get<double>(), 1e-3);
  EXPECT_NEAR(out["cost_m2"], 198 * std::pow(out["free_run_rms_m"].get<double>(), 2), 1e-12);
}

TEST_F(Estimate, DropsRowsAcrossAGap) {
  Record record = known(400);
  for (std::vector<double>* values : {&record.t_s, &record.u_V, &record.y_m}) {
    values->erase(values->begin() + 150, values->begin() + 170);
  }
  const json out = run(record, {"--structure", "arx211", "--constant"});
  expect_known(out);
  EXPECT_EQ(out["gaps"], 1);
  EXPECT_LT(out["free_run_rms_m"].get<double>(), 1e-9);
}

TEST_F(Estimate, TakesYAsRecordedUnlessADetrendIsAskedFor) {
  Record record = known(400);
  for (std::size_t i = 0; i < record.size(); ++i) record.y_m[i] = 0.305 + 1e-3 * record.u_V[i];
  const json raw = run(record, {"--structure", "arx011"});
  const json mean = run(record, {"--structure", "arx010", "--detrend", "mean"});
  EXPECT_NEAR(mean["b"][0], 1e-3, 1e-12);
  EXPECT_GT(raw["one_step_rms_m"].get<double>(), 0.2);
}

TEST_F(Estimate, SaysThatAConstantPositionDeterminesNothing) {
  Record record = known(100);
  for (double& y_m : record.y_m) y_m = 0.305;
  const json out = run(record, {"--structure", "arx111"});
  EXPECT_FALSE(out["valid"]);
  EXPECT_NE(out["reason"], "");
}

TEST_F(Estimate, RefusesARecordShorterThanTheRegressor) {
  try {
    run(known(12), {"--structure", "arx(10,10,1)"});
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_NE(std::string(error.what()).find("too short"), std::string::npos);
  }
}

TEST_F(Estimate, RefusesOptionsThatTheMethodDoesNotUse) {
  const std::vector<std::vector<std::string>> useless = {
      {"--stride", "0.1"},
      {"--forgetting", "0.9"},
      {"--prior-variance", "10"},
      {"--method", "recursive", "--window", "0.1"},
      {"--method", "sliding", "--window", "0.1", "--stride", "0.2"},
      {"--filter-low-Hz", "1"},
      {"--filter", "low", "--filter-high-Hz", "20", "--filter-low-Hz", "1"}};
  for (const auto& options : useless) {
    try {
      run(known(100), options);
      ADD_FAILURE() << options.front() << " accepted";
    } catch (const config::schema::UsageError& error) {
    }
  }
  EXPECT_THROW(run(known(100), {"--fit", "first-half", "--fit-from", "0.2"}), CLI::ParseError);
}

TEST_F(Estimate, RefusesNumbersThatAreNone) {
  for (const char* option : {"--window", "--stride", "--prior-variance", "--offset-m", "--fit-from",
                             "--fit-to", "--filter-low-Hz", "--forgetting"}) {
    for (const char* number : {"nan", "inf"}) {
      EXPECT_THROW(run(known(100), {"--method", "recursive", option, number}), CLI::ParseError)
          << option << ' ' << number;
    }
  }
}

/// u and y pass through the same filter, so the equation between them stays; from rest, so that
/// the filter's start leaves no trace.
TEST_F(Estimate, FiltersUAndYAlike) {
  Record record = known(400);
  double y1 = 0.0, y2 = 0.0, u1 = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double y = 1.5 * y1 - 0.6 * y2 + 2e-4 * u1;
    record.y_m[i] = 0.305 + y;
    y2 = y1;
    y1 = y;
    u1 = record.u_V[i];
  }
  const json band = run(record, {"--structure", "arx211", "--filter", "band", "--filter-low-Hz",
                                 "1", "--filter-high-Hz", "40"});
  EXPECT_NEAR(band["a"][0], -1.5, 1e-9);
  EXPECT_NEAR(band["a"][1], 0.6, 1e-9);
  EXPECT_NEAR(band["b"][0], 2e-4, 1e-12);
  try {
    run(record, {"--filter", "low", "--filter-high-Hz", "150"});
    FAIL() << "a corner above half the sampling rate";
  } catch (const config::schema::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("below 100"), std::string::npos) << error.what();
  }
}

TEST_F(Estimate, RefusesAWindowLongerThanTheRecord) {
  EXPECT_THROW(run(known(100), {"--window", "1.0"}), config::schema::Error);
}

TEST_F(Estimate, ReproducesTheReferenceErrorsOfTheFatigueRig) {
  const char* given = std::getenv("SPOOLWATCH_DATA");
  const std::filesystem::path data =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "../shared/data";
  if (!std::filesystem::exists(data / "faster/faster.csv")) {
    GTEST_SKIP() << "no measured records in " << data;
  }
  for (const char* structure : {"arx111", "arx221", "arx331", "arx441"}) {
    const json out = run_file(data / "faster/faster.csv",
                              {"--structure", structure, "--constant", "--fit", "first-half"});
    EXPECT_NEAR(1e3 * out["one_step_rms_m"].get<double>(), 0.0087, 0.0003) << structure;
    EXPECT_GT(1e3 * out["free_run_rms_m"].get<double>(), 0.53) << structure;
    EXPECT_LT(1e3 * out["free_run_rms_m"].get<double>(), 0.59) << structure;
  }
}

}  // namespace
}  // namespace workbench::estimate
