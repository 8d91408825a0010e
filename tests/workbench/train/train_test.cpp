// The bands and classifiers that one command learns from records, and their use.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/estimator/fdi/recorder.h"
#include "tests/workbench/train/trained_rig.h"

namespace workbench::train {
namespace {

TEST_F(Train, TeachesOneCommandWhatChangedInARecordNotSeenBefore) {
  train_all();
  EXPECT_NE(printed_.find("[[classifier]] fault: blocks of 2 s: healthy"), std::string::npos)
      << printed_;
  fdi::Pipeline pipeline(loaded(), 0.005);
  fdi_test::Recorder seen;
  const auto run = [&](const small_rig::Setup& setup) {
    pipeline.reset();
    seen.alarms.clear();
    for (const config::signals::Sample& sample : samples(setup, 30.0))
      pipeline.process(sample, seen);
  };
  run({.seed = 77});
  EXPECT_TRUE(seen.alarms.empty()) << seen.alarms.front().source << seen.alarms.front().reason;
  run({.supply_Pa = 0.9 * 6.89e6, .seed = 78});
  bool named = false;
  for (const fdi::Alarm& alarm : seen.alarms) {
    EXPECT_EQ(alarm.direction, alarm.source == "healthy" ? 1 : -1) << alarm.source;
    named = named || (alarm.source == "fault" && alarm.parameter == "supply");
  }
  EXPECT_TRUE(named);
  EXPECT_EQ(pipeline.alarms().active_count(), 3U) << "shifted, outside, and named";
  // Twice what it was taught is none of these.
  run({.supply_Pa = 1.2 * 6.89e6, .seed = 79});
  const fdi::AlarmBook& book = pipeline.alarms();
  EXPECT_NE(book.alarm(book.find("fault.fault")).reason.find("none of these"), std::string::npos);
}

TEST_F(Train, NamesSizesBetweenThoseTaughtAndRejectsAFaultThatWasNotTaught) {
  constexpr double kDuration_s = 70.0;
  std::vector<std::string> classes;
  unsigned seed = 1;
  record("healthy.csv", {.seed = seed}, kDuration_s);
  for (const double change : {-0.25, -0.1, 0.1, 0.25}) {
    const std::string name = "supply" + std::to_string(++seed) + ".csv";
    record(name, {.supply_Pa = (1.0 + change) * 6.89e6, .seed = seed}, kDuration_s);
    classes.emplace_back("--class");
    classes.push_back((change > 0.0 ? "supply+=" : "supply-=") + (folder_ / name).string());
  }
  train(classes);
  fdi::Pipeline pipeline(loaded(), 0.005);
  fdi_test::Recorder seen;
  const auto says = [&](const small_rig::Setup& setup) {
    pipeline.reset();
    for (const config::signals::Sample& sample : samples(setup, 30.0))
      pipeline.process(sample, seen);
    const fdi::AlarmBook& book = pipeline.alarms();
    const auto& alarm = book.alarm(book.find("fault.fault"));
    if (alarm.severity == fdi::Severity::ok) return std::string("well");
    return alarm.parameter.empty() ? std::string("none of these") : alarm.parameter;
  };
  for (const double change :
       {-0.25, -0.22, -0.17, -0.13, -0.1, -0.05, -0.02, 0.02, 0.05, 0.1, 0.13, 0.17, 0.22, 0.25}) {
    EXPECT_EQ(says({.supply_Pa = (1.0 + change) * 6.89e6, .seed = ++seed}), "supply") << change;
  }
  for (const double change : {-0.4, 0.4}) {
    EXPECT_EQ(says({.supply_Pa = (1.0 + change) * 6.89e6, .seed = ++seed}), "none of these")
        << change;
  }
  for (const double change : {-0.3, 0.3}) {
    EXPECT_EQ(says({.damping_N_s_per_m = (1.0 + change) * 1000.0, .seed = ++seed}), "none of these")
        << change;
  }
  EXPECT_EQ(says({.seed = ++seed}), "well");
}

TEST_F(Train, LeavesTheOldFileWhenARecordIsTooShort) {
  std::ofstream(folder_ / "trained.toml") << "old";
  record("healthy.csv", {}, 20.0);
  try {
    train();
    FAIL();
  } catch (const config::schema::DataError& error) {
    EXPECT_NE(std::string(error.what()).find("20 or more"), std::string::npos) << error.what();
  }
  std::ifstream in(folder_ / "trained.toml");
  EXPECT_EQ(std::string((std::istreambuf_iterator<char>(in)), {}), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 3);
}

TEST_F(Train, SaysThatNothingIsTrained) {
  std::string text = kConfig;
  write_config(text.substr(0, text.find("[[cusum]]")));
  record("healthy.csv", {}, 5.0);
  try {
    train();
    FAIL();
  } catch (const config::schema::ConfigError& error) {
  }
}

TEST(Summary, OfBlocksIsMeanCovarianceAndTheDeviationThatCountsOverLongRuns) {
  // x(t) = e(t) + e(t-1): variance 2, over long runs 4; y = -x.
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  train::Blocks blocks(2);
  for (auto& rows : blocks) {
    double before = normal(random);
    for (int i = 0; i < 20000; ++i) {
      const double e = normal(random);
      rows.push_back({5.0 + e + before, -e - before});
      before = e;
    }
  }
  const fdi::TrainedClass found = train::summarise(blocks, {"healthy", 0, {}}, "here");
  EXPECT_EQ(found.blocks, 40000);
  EXPECT_NEAR(found.mean[0], 5.0, 4.0 * 2.0 / std::sqrt(40000.0));
  EXPECT_NEAR(found.covariance[0], 2.0, 0.08);
  EXPECT_NEAR(found.covariance[1], -2.0, 0.08);
  // Bartlett's weights leave out 2/(L + 1) of the lag-1 part, L = 15: 2 + 2 (15/16) = 3.875.
  EXPECT_NEAR(found.long_run[0], std::sqrt(3.875) * (1.0 + 1.645 / std::sqrt(80000.0)), 0.06);
}

}  // namespace
}  // namespace workbench::train
