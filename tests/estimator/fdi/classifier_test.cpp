// The classifier: taught sizes, what lies between them, and what is none of these.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

using fdi_test::PlainValues;
using fdi_test::refusal;

std::string law(const std::string& name, double y, double u, int direction = 0) {
  return "[[classifier.class]]\nname = '" + name + "'\nblocks = 200\nmean = [" + std::to_string(y) +
         ", " + std::to_string(u) + "]\ncovariance = [1.0, 0.0, 0.0, 1.0]\n" +
         "long_run = [1.0, 1.0]\ndirection = " + std::to_string(direction) + "\n";
}

std::string classifier(const std::string& classes) {
  return "[[classifier]]\nid = 'c'\nfeatures = ['sample.y_m', 'sample.u_V']\nconfirm = 2\n" +
         classes;
}

TEST(Classifier, NamesTheFaultOnceItIsConfirmedAndSaysWhenItIsNoneOfThese) {
  PlainValues values(
      classifier(law("healthy", 0, 0) + law("pressure", 8, 0, 1) + law("damping", 0, 8, -1)));
  values.feed(0.5, 0.5);
  values.feed(8.0, 0.0);
  EXPECT_TRUE(values.alarms.empty()) << "one block is no confirmation";
  values.feed(8.0, 0.5);
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_EQ(values.alarms[0].parameter, "pressure");
  EXPECT_EQ(values.alarms[0].direction, 1);
  EXPECT_GT(values.alarms[0].confidence, 0.999);
  values.feed(0.0, 8.0);
  values.feed(0.0, 8.0);
  EXPECT_EQ(values.alarms.back().parameter, "damping");
  EXPECT_EQ(values.alarms.back().direction, -1);
  values.feed(30.0, 30.0);
  values.feed(30.0, 30.0);
  EXPECT_EQ(values.alarms.back().parameter, "");
  EXPECT_EQ(values.last("class"), -1.0);
  EXPECT_NE(values.alarms.back().reason.find("none of these"), std::string::npos);
  const std::size_t told = values.alarms.size();
  values.feed(0.0, 0.0);
  EXPECT_EQ(values.alarms.size(), told) << "one block takes nothing back";
  values.feed(0.0, 0.0);
  EXPECT_EQ(values.alarms.back().severity, Severity::ok);
  EXPECT_EQ(values.pipeline.alarms().active_count(), 0U);
}

TEST(Classifier, GivesTheClassesThatItCannotTellApartWithTheirProbability) {
  PlainValues values(classifier(law("healthy", 0, 0) + law("pressure", 8, 0) + law("gain", 8, 1)));
  // Beyond both; log of the ratio pressure : gain is (0.8^2 - 0.2^2)/2 = 0.3.
  for (int i = 0; i < 3; ++i) values.feed(8.2, 0.2);
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_EQ(values.alarms[0].parameter, "");
  EXPECT_EQ(values.alarms[0].ambiguity_group, (std::vector<std::string>{"pressure", "gain"}));
  EXPECT_NEAR(values.alarms[0].confidence, 1.0 / (1.0 + std::exp(-0.3)), 1e-6);
}

TEST(Classifier, IsRefusedWithoutClasses) {
  EXPECT_NE(refusal(classifier("")).find("not trained"), std::string::npos);
  EXPECT_NE(refusal(classifier(law("a", 0, 0) + law("b", 1, 1))).find("no class healthy"),
            std::string::npos);
}

/// The classifier's answer at a place; "": healthy.
std::string verdict(PlainValues& values, double y, double u) {
  values.restart();
  for (int i = 0; i < 2; ++i) values.feed(y, u);
  if (values.alarms.empty()) return "";
  const Alarm& alarm = values.alarms.back();
  if (!alarm.ambiguity_group.empty()) return "several";
  return alarm.parameter.empty() ? "none of these" : alarm.parameter;
}

/// A fault moves the mean along (t, t^2/8000), size t; another along (0, t).
std::string two_faults() {
  return classifier(law("healthy", 0, 0) + law("pressure", 1000, 125, 1) +
                    law("pressure", 2000, 500, 1) + law("damping", 0, 2000) +
                    law("damping", 0, 1000));
}

TEST(Classifier, TakesASizeBetweenThoseTaughtThoughTheChordIsThirtyDeviationsOffTheCurve) {
  PlainValues values(two_faults());
  for (const double t :
       {20.0, 100.0, 300.0, 500.0, 800.0, 1000.0, 1200.0, 1500.0, 1900.0, 2000.0}) {
    EXPECT_EQ(verdict(values, t, t * t / 8000.0), "pressure") << t;
  }
  for (const double t : {30.0, 600.0, 1000.0, 1400.0, 2000.0}) {
    EXPECT_EQ(verdict(values, 0.0, t), "damping") << t;
  }
  EXPECT_EQ(verdict(values, 1500.0, 1500.0 * 1500.0 / 8000.0), "pressure");
  EXPECT_EQ(values.alarms.back().direction, 1);
}

TEST(Classifier, RejectsOtherDirectionsWhatIsBetweenTwoFaultsAndWhatIsBeyondTheGreatestSize) {
  PlainValues values(two_faults());
  // The curve at 1500 may be off by its bend, 31: no more.
  EXPECT_EQ(verdict(values, 1500.0, 281.0 + 100.0), "none of these");
  EXPECT_EQ(verdict(values, 1500.0, 281.0 - 100.0), "none of these");
  EXPECT_EQ(verdict(values, 700.0, 700.0), "none of these");
  EXPECT_EQ(verdict(values, -500.0, 0.0), "none of these");
  EXPECT_EQ(verdict(values, 30.0, -30.0), "none of these");
  EXPECT_EQ(verdict(values, 2100.0, 2100.0 * 2100.0 / 8000.0), "none of these");
  EXPECT_EQ(verdict(values, 0.0, 2003.0), "damping") << "within its own spread";
}

TEST(Classifier, TakesASizeBelowTheOnlyOneTaughtFromWhereItLeavesTheHealthyRegion) {
  PlainValues values(classifier(law("healthy", 0, 0) + law("pressure", 40, 0, 1)));
  EXPECT_EQ(verdict(values, 4.0, 0.0), "") << "inside, T^2 = 16 of about 20";
  EXPECT_EQ(verdict(values, 6.0, 0.0), "pressure");
  EXPECT_EQ(verdict(values, 20.0, 2.0), "pressure");
  EXPECT_EQ(verdict(values, 20.0, 6.0), "none of these");
  EXPECT_EQ(verdict(values, -6.0, 0.0), "none of these");
  EXPECT_EQ(verdict(values, 47.0, 0.0), "none of these");
}

TEST(Classifier, JoinsNoSizesThatLieInDifferentDirections) {
  PlainValues values(classifier(law("healthy", 0, 0) + law("bias", 100, 0) + law("bias", 0, 110)));
  EXPECT_EQ(verdict(values, 50.0, 55.0), "none of these");
  EXPECT_EQ(verdict(values, 50.0, 0.0), "bias");
  EXPECT_EQ(verdict(values, 0.0, 55.0), "bias");
}

TEST(Classifier, CallsNoMoreHealthyBlocksAFaultThanTheStatedShare) {
  // Sizes as near to healthy as 7 deviations, all around it.
  std::string classes = law("healthy", 0, 0);
  for (int i = 0; i < 6; ++i) {
    const double angle = i * M_PI / 3.0;
    for (const double size : {7.0, 30.0}) {
      classes += law("fault" + std::to_string(i), size * std::cos(angle), size * std::sin(angle));
    }
  }
  for (std::size_t at = 0; (at = classes.find("blocks = 200", at)) != std::string::npos;) {
    classes.replace(at, 12, "blocks = 100000");
  }
  std::string rules = classifier(classes);
  rules.replace(rules.find("confirm = 2"), 11, "confirm = 1\nrejection = 0.01");
  PlainValues values(rules);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kBlocks = 40000;
  int wrong = 0;
  for (int i = 0; i < kBlocks; ++i) {
    values.feed(normal(random), normal(random));
    wrong += values.last("class") != 0.0 ? 1 : 0;
  }
  // Outside the region 1 %; within it, nearer to a taught size than to healthy: six half planes
  // beyond 3.5, edge 3.03, add nothing.
  EXPECT_NEAR(wrong, 0.01 * kBlocks, 4.0 * std::sqrt(0.01 * kBlocks));
}

}  // namespace
}  // namespace estimator::fdi
