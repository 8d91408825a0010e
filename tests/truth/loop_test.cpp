// Controller, sample times, repeating motions and the log, apart from the plant's equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/truth/case.h"
#include "tests/truth/conditions.h"

namespace truth {
namespace {

Case of_text(const std::string& text) { return parse_case("plant=printed," + text, 5); }

std::vector<double> reference(const Case& of) {
  Random random(of.seed);
  return reference_m(of.motion, static_cast<std::size_t>(std::lround(of.length_s / of.sample_s)),
                     random, of.sample_s);
}

TEST(TruthLoop, FollowsTheSameMotionAtAnyRate) {
  for (const char* motion : {"multisine", "sine", "triangle", "chirp"}) {
    const auto slow = reference(of_text(std::string("length_s=4,motion=") + motion));
    const auto fast = reference(of_text(std::string("length_s=4,sample_s=0.001,motion=") + motion));
    ASSERT_EQ(fast.size(), 5 * slow.size());
    for (std::size_t k = 0; k < slow.size(); ++k) {
      ASSERT_NEAR(fast[5 * k], slow[k], 1e-12) << motion;
    }
  }
}

TEST(TruthLoop, DelaysTheCommandByTheSameTimeAtAnyRate) {
  Hidden late;
  late.delay_s = 0.0075;
  for (const double sample_s : {0.001, 0.005, 0.05}) {
    Rig delayed(std::make_unique<Axis>(AxisPlant{}, late, LeftOut{}), 0, {}, 0, sample_s);
    Rig prompt(std::make_unique<Axis>(AxisPlant{}, Hidden{}, LeftOut{}), 0, {}, 0, sample_s);
    const long samples = std::lround(10.0 / sample_s);
    for (long k = 0; k < samples; ++k) {
      delayed.hold(1.0);
      prompt.hold(1.0);
    }
    EXPECT_NEAR(prompt.x[0] - delayed.x[0], 0.0075 * prompt.x[1], 1e-6) << sample_s;
  }
}

TEST(TruthLoop, ALagOfTheDriveLosesTheTravelOfItsLength) {
  Hidden lagging;
  lagging.lag_s = 0.0075;
  Rig slow(std::make_unique<Axis>(AxisPlant{}, lagging, LeftOut{}), 0, {}, 0, 0.005);
  Rig prompt(std::make_unique<Axis>(AxisPlant{}, Hidden{}, LeftOut{}), 0, {}, 0, 0.005);
  for (long k = 0; k < 2000; ++k) {
    slow.hold(1.0);
    prompt.hold(1.0);
  }
  EXPECT_NEAR(prompt.x[0] - slow.x[0], 0.0075 * prompt.x[1], 1e-6);
}

TEST(TruthLoop, ActsAsItsGainsSay) {
  const Case of = of_text(
      "rig=linear_axis,motion=multisine,length_s=3,kp_V_per_m=150,ki_V_per_m_s=80,"
      "kd_V_s_per_m=20,feed_V_s_per_m=3");
  const Record record = simulate(of);
  const auto r_m = reference(of);
  double sum_m_s = 0.0;
  for (std::size_t k = 1; k + 1 < r_m.size(); ++k) {
    if (k == 1) sum_m_s = (r_m[0] - record.y_m[0]) * 0.005;
    sum_m_s += (r_m[k] - record.y_m[k]) * 0.005;
    const double expected_V = 150.0 * (r_m[k] - record.y_m[k]) + 80.0 * sum_m_s -
                              20.0 * (record.y_m[k] - record.y_m[k - 1]) / 0.005 +
                              3.0 * (r_m[k + 1] - r_m[k]) / 0.005;
    if (std::abs(expected_V) > 9.9) FAIL() << "the test's motion is too fast";
    ASSERT_NEAR(record.u_V[k], expected_V, 0.51 * of.converter_V);
  }
}

TEST(TruthLoop, LeavesANullBiasToProportionalControlAndTakesItAwayWithAnIntegral) {
  const auto last_m = [](const std::string& more) {
    const Record record = simulate(
        of_text("motion=sine,amplitude_ratio=0,length_s=12,converter_V=0,encoder_m=0,noise_m=0,"
                "null_bias.offset_V=0.07" +
                more));
    return record.y_m.back() - kCentre_m;
  };
  EXPECT_NEAR(last_m(""), 0.07 / 100.0, 1e-8);
  EXPECT_NEAR(last_m(",ki_V_per_m_s=150"), 0.0, 1e-7);
}

TEST(TruthLoop, MovesWithoutAControllerByItsFeedForwardAlone) {
  for (const char* sample : {"0.005", "0.001"}) {
    const std::string open =
        "motion=multisine,length_s=3,kp_V_per_m=0,feed_V_s_per_m=20,sample_s=" +
        std::string(sample);
    const Record record = simulate(of_text(open));
    EXPECT_EQ(record.u_V, simulate(of_text(open + ",noise_m=1e-4")).u_V);
    const auto r_m = reference(of_text(open));
    const auto [least, most] = std::minmax_element(r_m.begin(), r_m.end());
    const auto [low, high] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    EXPECT_NEAR((*high - *low) / (*most - *least), 1.0, 0.1) << sample;
  }
}

TEST(TruthLoop, ScalesTheMotionAboutItsCentre) {
  const Record whole = simulate(of_text("motion=sine,length_s=8"));
  const Record tenth = simulate(of_text("motion=sine,length_s=8,amplitude_ratio=0.1"));
  const auto span = [](const Record& of) {
    const auto [low, high] = std::minmax_element(of.reading_m.begin(), of.reading_m.end());
    return *high - *low;
  };
  EXPECT_NEAR(span(tenth) / span(whole), 0.1, 2e-3);
}

TEST(TruthLoop, RepeatsAMotionWithoutAJump) {
  std::vector<double> period_m;
  for (int k = 0; k < 100; ++k) period_m.push_back(0.3 + 1e-3 * k);  // a ramp: all of it is gap
  std::vector<double> r_m = period_m;
  repeat(r_m, 350);
  ASSERT_EQ(r_m.size(), 350U);
  for (const double r : r_m) EXPECT_NEAR(r, 0.35, 1e-12);
  for (const char* motion : {"multisine", "fast_steps", "chirp"}) {
    Random random(3);
    std::vector<double> of_m = reference_m(motion, 1000, random);
    repeat(of_m, 3000);
    double most_m = 0.0;
    for (std::size_t k = 1; k < 900; ++k) {
      most_m = std::max(most_m, std::abs(of_m[k] - of_m[k - 1]));
    }
    for (std::size_t k = 1000; k < 3000; ++k) ASSERT_EQ(of_m[k], of_m[k - 1000]);
    EXPECT_LE(std::abs(of_m[1000] - of_m[999]), 2.0 * most_m) << motion;
  }
}

TEST(TruthLoop, ShowsTheSameInEveryPeriodOfAMotionThatRepeats) {
  const Record record = simulate(of_text(
      "motion=multisine,length_s=20,period_s=5,noise_m=0,encoder_m=0,converter_V=0,plant=printed"));
  for (std::size_t k = 1000; k < 3000; ++k) {
    ASSERT_NEAR(record.y_m[k], record.y_m[k + 1000], 1e-6);
  }
}

/// Rows of a log that was written and read back.
std::vector<std::array<double, 3>> logged(const Record& record) {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("spoolwatch_truth_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv");
  write_csv(record, file.string());
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<std::array<double, 3>> rows;
  while (std::getline(in, line)) {
    std::array<double, 3> row{};
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &row[0], &row[1], &row[2]) == 3) {
      rows.push_back(row);
    }
  }
  std::filesystem::remove(file);
  return rows;
}

TEST(TruthLog, HoldsEveryNthRowOfTheLoop) {
  const Record all = simulate(of_text("motion=multisine,length_s=2"));
  const Record thin = simulate(of_text("motion=multisine,length_s=2,log_every=10"));
  EXPECT_EQ(all.y_m, thin.y_m);
  const auto rows = logged(thin);
  ASSERT_EQ(rows.size(), 40U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_NEAR(rows[k][0], 0.05 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(rows[k][1], all.u_V[10 * k], 1e-6);
    EXPECT_NEAR(rows[k][2], all.y_m[10 * k], 1e-6);
  }
}

TEST(TruthLog, HoldsTheMeanOfTheCommandWhereItIsToldTo) {
  const Record all = simulate(of_text("motion=multisine,length_s=2"));
  const auto rows = logged(simulate(of_text("motion=multisine,length_s=2,log_every=4,log_mean=1")));
  ASSERT_EQ(rows.size(), 100U);
  double apart_V = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double mean_V = 0.0;
    for (std::size_t i = 4 * k; i < 4 * k + 4; ++i) mean_V += 0.25 * all.u_V[i];
    EXPECT_NEAR(rows[k][1], mean_V, 1e-6);
    EXPECT_NEAR(rows[k][2], all.y_m[4 * k], 1e-6);
    apart_V = std::max(apart_V, std::abs(mean_V - all.u_V[4 * k]));
  }
  EXPECT_GT(apart_V, 1e-3);
}

TEST(TruthConditions, ChangeTheCaseAndComeBackFromItsText) {
  EXPECT_EQ(conditions().size(), 11U);
  const Case plain = of_text("motion=multisine");
  for (const Condition& condition : conditions()) {
    Case of = plain;
    condition.apply(of);
    if (!condition.motions.empty()) of.motion = condition.motions.front();
    EXPECT_NE(to_text(of), to_text(plain)) << condition.name;
    EXPECT_EQ(to_text(parse_case(to_text(of), 5)), to_text(of)) << condition.name;
  }
}

}  // namespace
}  // namespace truth
