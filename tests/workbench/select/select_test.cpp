// The comparison of structures on records whose structure is known, and the command around it.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/estimator/structures/data.h"
#include "tests/workbench/run_command.h"
#include "workbench/select/outcome.h"
#include "workbench/select/words.h"

namespace workbench::select {
namespace {

namespace fs = std::filesystem;
namespace data = estimator::structures::testing_data;
using nlohmann::json;
using structures::Polynomial;
using testing::HasSubstr;

/// Standard output while this lives.
struct Captured {
  std::ostringstream text;
  std::streambuf* const before = std::cout.rdbuf(text.rdbuf());
  Captured() = default;
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  ~Captured() { std::cout.rdbuf(before); }
};

class Select : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("select_") + info->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Written at 200 Hz.
  std::string write(const data::Record& of, double y_scale_m = 1.0) const {
    config::record::Record out;
    for (std::size_t t = 0; t < of.y_m.size(); ++t) {
      out.t_s.push_back(0.005 * static_cast<double>(t));
      out.u_V.push_back(of.u_V[t]);
      out.y_m.push_back(y_scale_m * of.y_m[t]);
    }
    if (!of.reference_m.empty()) out.further.emplace_back("reference_m", of.reference_m);
    std::string file = (folder_ / "record.csv").string();
    write_csv(out, file);
    return file;
  }
  json run(std::vector<std::string> arguments) const {
    const std::string file = (folder_ / "out.json").string();
    for (const char* more : {"--quiet", "--json", file.c_str()}) arguments.emplace_back(more);
    const Captured captured;
    workbench_test::run_command(workbench::cli::add_select, arguments);
    text_ = captured.text.str();
    return json::parse(std::ifstream(file));
  }
  int code(const std::vector<std::string>& arguments, std::string& line) const {
    try {
      run(arguments);
    } catch (const config::schema::Error& error) {
      line = error.what();
      return config::schema::exit_code_of(error);
    }
    return 0;
  }
  static const json& row(const json& all, const std::string& name) {
    for (const json& one : all["structures"]) {
      if (one["structure"] == name) return one;
    }
    throw std::runtime_error("no row " + name);
  }

  fs::path folder_;
  mutable std::string text_;
};

const Polynomial kArmax{.a = {-1.5, 0.7}, .b = {1.0}, .c = {0.9}, .d = {}, .f = {}};

TEST_F(Select, GivesTheTrueStructureTheLeastBic) {
  // BIC is consistent: on 4000 samples the true one of these wins, and by more than ln N = 8.3 for
  // the next larger.
  const std::string file = write(data::random_record(kArmax, 8000, 0.3, 1), 1e-3);
  const json out = run({file, "--structures", "arx211,arx411,armax2111,armax3231,oe121,bj11121"});
  double least = INFINITY;
  std::string best;
  for (const json& one : out["structures"]) {
    ASSERT_TRUE(one["valid"]) << one["why"];
    if (one["bic"] < least) best = one["structure"], least = one["bic"];
  }
  EXPECT_EQ(best, "armax2111");
  EXPECT_NEAR(row(out, "armax2111")["one_step_rms_m"].get<double>(), 0.3e-3, 0.01e-3);
  EXPECT_GT(row(out, "armax2111")["whiteness_p"].get<double>(), 1e-3);
  EXPECT_LT(row(out, "arx211")["whiteness_p"].get<double>(), 1e-6);
}

TEST_F(Select, ListsEveryFamilyBestFirstAndRecommendsOneWithItsReason) {
  const std::string file = write(data::closed_loop(6000, 2e-6, 5e-6, 2));
  const json out = run({file});
  std::set<std::string> families;
  double last = 0.0;
  for (const json& one : out["structures"]) {
    families.insert(one["family"]);
    if (!one["cost_m2"].is_number()) continue;
    EXPECT_GE(one["cost_m2"].get<double>(), last);
    last = one["cost_m2"];
  }
  EXPECT_THAT(families, testing::UnorderedElementsAre("ARX", "ARMAX", "output error", "Box-Jenkins",
                                                      "state space", "NARX network"));
  const std::string chosen = out["recommended"];
  EXPECT_TRUE(row(out, chosen)["on_line"]["sound"]);
  EXPECT_LE(row(out, chosen)["cost_m2"].get<double>(),
            1.25 * out["structures"][0]["cost_m2"].get<double>());
  EXPECT_THAT(out["reason"].get<std::string>(), HasSubstr("period to period"));
  EXPECT_THAT(text_, HasSubstr("recommended: " + chosen));
  // An integrating rod: output error cannot follow on line, and its row says why.
  EXPECT_EQ(row(out, "oe121")["on_line"]["method"], "none");
  EXPECT_THAT(row(out, "oe121")["on_line"]["why"].get<std::string>(), HasSubstr("unit circle"));
  EXPECT_EQ(row(out, "arx211")["on_line"]["method"], "RLS");
}

TEST_F(Select, CostsAndVarianceAreThoseOfTheSource) {
  // Noise-free: E is rounding, the coefficients are the same in every period.
  Polynomial truth = kArmax;
  truth.c.clear();
  const std::string file = write(data::random_record(truth, 4000, 0.0, 3));
  const json out = run({file, "--structures", "arx211", "--keep-offset", "--no-constant"});
  const json& arx = out["structures"][0];
  EXPECT_LT(arx["cost_m2"].get<double>(), 1e-20);
  EXPECT_EQ(out["scored_periods"], 4);  // (2000 - 50) / 400
  EXPECT_EQ(arx["periods"], 10);
  EXPECT_LT(arx["spread"].get<double>(), 1e-9);
  EXPECT_NEAR(arx["period_mean"][2].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(arx["names"], json({"a1", "a2", "b1"}));
}

TEST_F(Select, SpreadIsTheScatterThatTheStandardErrorsForetell) {
  Polynomial truth = kArmax;
  truth.c.clear();
  const std::string file = write(data::random_record(truth, 40000, 0.3, 4));
  const json out = run({file, "--structures", "arx211"});
  const json& arx = out["structures"][0];
  for (std::size_t i = 0; i < 3; ++i) {
    // Half the record is fitted: 50 periods; one period's variance is 50 times as large. 100
    // periods know a variance to 14 %.
    const double se = arx["std_error"][i];
    EXPECT_NEAR(arx["period_variance"][i].get<double>() / (50.0 * se * se), 1.0, 0.6);
  }
}

TEST_F(Select, TellsBiasInClosedLoopFromTheRecordsReference) {
  const std::string file = write(data::closed_loop(12000, 1e-6, 2e-4, 5));
  const json out = run({file, "--structures", "arx211"});
  const json& bias = out["structures"][0]["bias"];
  EXPECT_EQ(bias["instruments"], "reference");
  EXPECT_EQ(bias["verdict"], "biased");
  EXPECT_NEAR(bias["instrumental"][2].get<double>(), 2e-4,
              4.0 * bias["instrumental_std_error"][2].get<double>());
  EXPECT_THAT(out["bias"].get<std::string>(), HasSubstr("biased"));
}

TEST_F(Select, FindsTheDelay) {
  Polynomial truth = kArmax;
  truth.k = 4;
  const json out = run({write(data::random_record(truth, 6000, 0.1, 6)), "--structures", "ss2"});
  EXPECT_EQ(out["delay"], 4);
  EXPECT_TRUE(out["structures"][0]["valid"]);
  EXPECT_NEAR(out["structures"][0]["value"][0].get<double>(), -1.5, 0.05);
}

TEST_F(Select, RunsTheRecursiveFormsToTheBatchResult) {
  const json out = run({write(data::random_record(kArmax, 8000, 0.3, 7)), "--structures",
                        "arx211,armax2111,oe121,bj11121"});
  for (const json& one : out["structures"]) {
    EXPECT_TRUE(one["on_line"]["sound"]) << one["structure"];
    EXPECT_NEAR(one["on_line"]["free_run_rms_m"].get<double>(), one["free_run_rms_m"].get<double>(),
                0.02 * one["free_run_rms_m"].get<double>())
        << one["structure"];
  }
}

TEST_F(Select, NamesAnotherToFollowOnLineWhereTheBestCannot) {
  // A valve that saturates: only the network represents it well.
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  data::Record record;
  double y = 0.0, u = 0.0;
  for (int t = 0; t < 3000; ++t) {
    y = 0.8 * y + 1e-3 * std::tanh(3.0 * u) + 1e-6 * normal(random);
    u = normal(random);
    record.y_m.push_back(y);
    record.u_V.push_back(u);
  }
  const json out = run({write(record), "--structures", "arx111,arx411,narx111/3,ss2"});
  EXPECT_EQ(out["recommended"], "narx111/3");
  EXPECT_EQ(out["on_line"].get<std::string>().substr(0, 3), "arx");
  EXPECT_THAT(text_, HasSubstr("to follow on line: arx"));
}

TEST_F(Select, RefusesInOneClearLine) {
  std::string line;
  const std::string good = write(data::closed_loop(2000, 1e-6, 5e-6, 8));
  EXPECT_EQ(code({good, "--structures", "arx211,foo"}, line), 2);
  EXPECT_THAT(line, HasSubstr("unknown \"foo\""));
  for (const char* bad : {"ss0", "n4sid10", "narx211/99", "narx21", "arx99", "narx001"}) {
    EXPECT_EQ(code({good, "--structures", bad}, line), 2) << bad;
  }
  EXPECT_EQ(code({(folder_ / "none.csv").string()}, line), 65);
  EXPECT_EQ(code({write(data::closed_loop(60, 1e-6, 5e-6, 8))}, line), 65);
  EXPECT_THAT(line, HasSubstr("too short"));
  data::Record still = data::closed_loop(2000, 1e-6, 5e-6, 8);
  for (double& u : still.u_V) u = 1.0;
  EXPECT_EQ(code({write(still)}, line), 65);
  EXPECT_THAT(line, HasSubstr("u_V never changes"));
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(SelectWords, PrintNumbersShortly) {
  EXPECT_EQ(number_words(12.345, 2), "12");
  EXPECT_EQ(number_words(1.2345, 3), "1.23");
  EXPECT_EQ(number_words(0.012345, 2), "0.012");
  EXPECT_EQ(number_words(1.2e-5, 2), "1.2e-05");
  EXPECT_EQ(number_words(NAN, 2), "-");
  EXPECT_EQ(more_words(1.05), "5.0 % more than");
  EXPECT_EQ(more_words(3.0), "3.0 times");
}

}  // namespace
}  // namespace workbench::select
