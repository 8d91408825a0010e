// Faults made by hand in records of the independent simulator.
#include "estimator/greybox/reading_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/truth/case.h"
#include "tests/truth/rig.h"

namespace estimator::greybox {
namespace {

Dataset record_of(const std::string& spec) {
  const truth::Record record = truth::simulate(truth::parse_case(spec, 91));
  return dataset_of(0.005, record.u_V, record.y_m);
}

Dataset record() { return record_of("motion=multisine,length_s=20"); }

/// The position that a share of the samples stays below.
double quantile_m(const Dataset& of, double share) {
  std::vector<double> sorted = of.y_m;
  std::sort(sorted.begin(), sorted.end());
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

TEST(ReadingFaults, AHealthyRecordHasNone) {
  for (const char* spec : {"motion=multisine,length_s=20", "motion=fast_steps,length_s=20",
                           "motion=slow_steps,length_s=20", "motion=sine,length_s=20"}) {
    const ReadingFaults faults = reading_faults(record_of(spec));
    EXPECT_TRUE(faults.leaps.empty()) << spec;
    EXPECT_TRUE(faults.stuck.empty()) << spec;
  }
}

/// 10 Hz, at rest but for a step of the command every ten seconds that the rod overshoots.
Dataset resting() {
  std::vector<double> u_V(600, 0.0);
  std::vector<double> y_m(600);
  double at_m = 0.3;
  for (std::size_t k = 0; k < y_m.size(); ++k) {
    const std::size_t within = k % 100;
    if (within == 10) u_V[k] = 1.0;
    if (within == 11) at_m += 0.05;
    y_m[k] = at_m + (within == 11 ? 0.01 : 0.0);
  }
  return dataset_of(0.1, u_V, y_m);
}

TEST(ReadingFaults, AnOvershootOfARodThatMostlyRestsIsNoLeap) {
  EXPECT_TRUE(reading_faults(resting()).leaps.empty());
}

TEST(ReadingFaults, AJabThatIsCommandedIsNoLeapAndOneThatIsNotIs) {
  Dataset jabbed = resting();
  std::fill(jabbed.y_m.begin(), jabbed.y_m.end(), 0.3);
  for (std::size_t k = 111; k < 600; k += 100) jabbed.y_m[k] = 0.32;
  jabbed.y_m[450] = 0.31;
  const ReadingFaults faults = reading_faults(jabbed);
  ASSERT_EQ(faults.leaps.size(), 1U);
  EXPECT_EQ(faults.leaps.front().begin, 450U);
}

// A turning point lasts long in steps of a tenth of a millimetre.
TEST(ReadingFaults, ACoarseEncoderTurnsWithoutBeingStuck) {
  Dataset coarse = record();
  for (double& y_m : coarse.y_m) y_m = 1e-4 * std::round(1e4 * y_m);
  const ReadingFaults faults = reading_faults(coarse);
  EXPECT_TRUE(faults.leaps.empty());
  EXPECT_TRUE(faults.stuck.empty());
}

TEST(ReadingFaults, ASensorsRangeEndsWhereItsReadingStays) {
  Dataset clipped = record();
  const double most_m = quantile_m(clipped, 0.9);
  std::size_t beyond = 0;
  for (double& y_m : clipped.y_m) {
    beyond += y_m > most_m ? 1 : 0;
    y_m = std::min(y_m, most_m);
  }
  const ReadingFaults faults = reading_faults(clipped);
  ASSERT_EQ(faults.stuck.size(), 1U);
  EXPECT_EQ(faults.stuck.front().value_m, most_m);
  std::size_t found = 0;
  for (const SampleRange& span : faults.stuck.front().spans) found += span.end - span.begin;
  EXPECT_GT(found, 8 * beyond / 10);
  EXPECT_LE(found, beyond + 10);
}

TEST(ReadingFaults, ASpikeBeyondItDoesNotHideAnEnd) {
  Dataset clipped = record();
  const double most_m = quantile_m(clipped, 0.9);
  for (double& y_m : clipped.y_m) y_m = std::min(y_m, most_m);
  clipped.y_m[1500] = 9.99;
  const ReadingFaults faults = reading_faults(clipped);
  EXPECT_EQ(faults.leaps.size(), 1U);
  ASSERT_EQ(faults.stuck.size(), 1U);
  EXPECT_EQ(faults.stuck.front().value_m, most_m);
}

// 1 V holds the rod at its greatest reading, in steps of a micrometre, for three seconds.
TEST(ReadingFaults, ANullThatTheLoopHoldsIsNoMotion) {
  Dataset held = record();
  const double most_m = 1e-6 * std::ceil(1e6 * quantile_m(held, 1.0));
  for (std::size_t k = 0; k < held.size(); ++k) {
    held.y_m[k] = k < 600 ? most_m : 1e-6 * std::round(1e6 * held.y_m[k]);
    held.u_V[k] = k < 600 ? 1.0 : held.u_V[k] + 1.0;
  }
  EXPECT_TRUE(reading_faults(held).stuck.empty());
}

TEST(ReadingFaults, AReadingThatStaysAwayForThreeSamplesIsNoLeap) {
  Dataset away = record();
  for (const std::size_t k : {1500U, 1501U, 1502U}) away.y_m[k] = 9.99;
  EXPECT_TRUE(reading_faults(away).leaps.empty());
}

TEST(ReadingFaults, ALeapIsFoundUpToTheThirdSampleOfASegment) {
  Dataset segments = record();
  segments.starts = {0, 2000};
  for (const std::size_t leap : {1996U, 1997U, 2002U, 2003U}) {
    Dataset leaping = segments;
    leaping.y_m[leap] = 9.99;
    const ReadingFaults faults = reading_faults(leaping);
    ASSERT_EQ(faults.leaps.size(), 1U) << leap;
    EXPECT_EQ(faults.leaps[0].begin, leap);
    EXPECT_EQ(faults.leaps[0].end, leap + 1);
  }
  for (const std::size_t edge : {1998U, 1999U, 2000U, 2001U}) {
    Dataset leaping = segments;
    leaping.y_m[edge] = 9.99;
    EXPECT_TRUE(reading_faults(leaping).leaps.empty()) << edge;
  }
}

/// Steps of 1 mm between turns every second, as fast as the rod ever moves.
Dataset sawtooth() {
  std::vector<double> u_V(2000);
  std::vector<double> y_m(2000, 0.2);
  for (std::size_t k = 1; k < y_m.size(); ++k) {
    u_V[k] = (k / 200) % 2 == 0 ? 1.0 : -1.0;
    y_m[k] = y_m[k - 1] + 1e-3 * u_V[k];
  }
  return dataset_of(0.005, u_V, y_m);
}

// Within the two samples the rod moves by more than a quarter of the leap.
TEST(ReadingFaults, ALeapOutOfAFastMotionIsFound) {
  EXPECT_TRUE(reading_faults(sawtooth()).leaps.empty());
  for (const double leap_m : {6e-3, -6e-3}) {
    Dataset leaping = sawtooth();
    leaping.y_m[500] += leap_m;
    const ReadingFaults faults = reading_faults(leaping);
    ASSERT_EQ(faults.leaps.size(), 1U) << leap_m;
    EXPECT_EQ(faults.leaps.front().begin, 500U);
    EXPECT_EQ(faults.leaps.front().end, 501U);
  }
}

TEST(ReadingFaults, TwoSamplesThatLeapAreOneLeap) {
  Dataset leaping = record();
  leaping.y_m[1500] = 9.99;
  leaping.y_m[1501] = -9.99;
  const ReadingFaults faults = reading_faults(leaping);
  ASSERT_EQ(faults.leaps.size(), 1U);
  EXPECT_EQ(faults.leaps[0].begin, 1500U);
  EXPECT_EQ(faults.leaps[0].end, 1502U);
}

TEST(ReadingFaults, ASampleThatLeapsIsFoundWhereItIs) {
  Dataset leaping = record();
  leaping.y_m[1500] = 9.99;
  leaping.y_m[2200] = leaping.y_m[2201] = 0.0;
  const ReadingFaults faults = reading_faults(leaping);
  ASSERT_EQ(faults.leaps.size(), 2U);
  EXPECT_EQ(faults.leaps[0].begin, 1500U);
  EXPECT_EQ(faults.leaps[0].end, 1501U);
  EXPECT_EQ(faults.leaps[1].begin, 2200U);
  EXPECT_EQ(faults.leaps[1].end, 2202U);
  EXPECT_TRUE(faults.stuck.empty());
}

}  // namespace
}  // namespace estimator::greybox
