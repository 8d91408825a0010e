// The vote over redundant channels: which is out, since when, and what is still known.
#include "estimator/fdi/voter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

using fdi_test::PlainValues;
using fdi_test::refusal;

constexpr Vote::Rules kRules{1.0, 3, 5};

/// The same channels `times` times.
void take(Vote& vote, std::vector<double> values, int times) {
  for (int i = 0; i < times; ++i) vote.update(values);
}

TEST(Vote, OfThreeFollowsTheMiddleWhileOneGoesAway) {
  Vote vote(3, kRules);
  take(vote, {10.0, 10.2, 10.1}, 10);
  EXPECT_DOUBLE_EQ(vote.value(), 10.1);
  take(vote, {10.0, 50.0, 10.1}, 2);
  EXPECT_FALSE(vote.channel(1).out) << "not confirmed yet";
  EXPECT_DOUBLE_EQ(vote.value(), 10.1) << "and yet it has no say";
  take(vote, {10.0, 50.0, 10.1}, 1);
  EXPECT_TRUE(vote.channel(1).out);
  EXPECT_EQ(vote.channel(1).since, 11);
  EXPECT_FALSE(vote.channel(0).out);
  take(vote, {10.0, 50.0, 10.1}, 1);
  EXPECT_DOUBLE_EQ(vote.value(), 10.05) << "the mean of the two that are left";
}

TEST(Vote, ComesBackOnlyAfterAgreeingForLong) {
  Vote vote(3, kRules);
  take(vote, {10.0, 50.0, 10.0}, 5);
  ASSERT_TRUE(vote.channel(1).out);
  take(vote, {10.0, 10.0, 10.0}, 4);
  take(vote, {10.0, 50.0, 10.0}, 1);
  take(vote, {10.0, 10.0, 10.0}, 4);
  EXPECT_TRUE(vote.channel(1).out);
  take(vote, {10.0, 10.0, 10.0}, 1);
  EXPECT_FALSE(vote.channel(1).out);
}

TEST(Vote, OfTwoKnowsThatTheyDifferButNotWhichIsRight) {
  Vote vote(2, kRules);
  take(vote, {10.0, 10.4}, 5);
  EXPECT_DOUBLE_EQ(vote.value(), 10.2);
  take(vote, {10.0, 12.0}, 3);
  EXPECT_TRUE(vote.disagree());
  EXPECT_TRUE(std::isnan(vote.value()));
  EXPECT_FALSE(vote.channel(0).out || vote.channel(1).out);
  take(vote, {10.0, 10.0}, 1);
  EXPECT_FALSE(vote.disagree());
}

TEST(Vote, OfTwoGoesOnWithTheOneThatIsThere) {
  Vote vote(2, kRules);
  take(vote, {10.0, std::nan("")}, 3);
  EXPECT_DOUBLE_EQ(vote.value(), 10.0);
  EXPECT_TRUE(vote.channel(1).out);
  take(vote, {std::nan(""), std::nan("")}, 1);
  EXPECT_TRUE(vote.disagree());
}

TEST(Vote, OfThreeSurvivesTwoFaultsOneAfterTheOther) {
  Vote vote(3, kRules);
  take(vote, {10.0, 50.0, 10.0}, 5);
  take(vote, {10.0, 50.0, std::nan("")}, 5);
  EXPECT_DOUBLE_EQ(vote.value(), 10.0);
  EXPECT_TRUE(vote.channel(1).out && vote.channel(2).out);
  EXPECT_FALSE(vote.channel(0).out);
}

TEST(Vote, GoesOnWithThoseThatComeBackAfterAllWereMissing) {
  const double none = std::nan("");
  for (const std::size_t channels : {2u, 3u}) {
    Vote vote(channels, kRules);
    const auto feed = [&](double a, double b, double c, int times) {
      const double values[] = {a, b, c};
      for (int i = 0; i < times; ++i) vote.update(std::span(values).first(channels));
    };
    feed(none, none, none, 10);  // from the start, as estimators are while they warm up
    EXPECT_TRUE(vote.disagree());
    feed(10.0, 10.2, 10.1, 4);
    EXPECT_TRUE(std::isnan(vote.value()));
    feed(10.0, 10.2, 10.1, 2);
    EXPECT_DOUBLE_EQ(vote.value(), 10.1) << channels;
    EXPECT_FALSE(vote.disagree());
    feed(none, none, none, 10);
    feed(10.0, 13.0, none, 20);
    EXPECT_TRUE(vote.disagree()) << "two that differ do not come back";
    feed(10.0, none, none, 6);
    EXPECT_DOUBLE_EQ(vote.value(), 10.0) << "the only one";
  }
}

TEST(Vote, DoesNotTrustAnOutvotedChannelThatIsTheOnlyOneLeft) {
  const double none = std::nan("");
  Vote vote(3, kRules);
  take(vote, {10.0, 50.0, 10.0}, 5);
  take(vote, {none, 50.0, none}, 30);
  EXPECT_TRUE(std::isnan(vote.value()));
  take(vote, {10.0, 50.0, 10.0}, 6);
  EXPECT_DOUBLE_EQ(vote.value(), 10.0);
  EXPECT_TRUE(vote.channel(1).out);
}

const char* const kVoter =
    "[[voter]]\nid = 'rods'\nchannels = ['sample.y_m', 'sample.u_V', 'sample.reference_m']\n"
    "tolerance = 1.0\nconfirm_s = 3.0\nreturn_s = 5.0\nstride_s = 10.0\n"
    "[[band]]\nid = 'far'\nquantity = 'rods.value'\nhigh = 11.0\n";

TEST(Voter, NamesTheChannelThatIsOutAndItsValueIsWatchedLikeAnyOther) {
  PlainValues values(kVoter);
  for (int i = 0; i < 20; ++i) values.feed(10.0, 10.1, 10.2);
  EXPECT_EQ(values.estimates, 2);
  EXPECT_DOUBLE_EQ(values.last("value"), 10.1);
  for (int i = 0; i < 3; ++i) values.feed(90.0, 10.1, 10.2);
  ASSERT_EQ(values.alarms.size(), 1U) << "told at once, not a stride later";
  EXPECT_EQ(values.alarms[0].name, "channel_out");
  EXPECT_EQ(values.alarms[0].parameter, "sample.y_m");
  EXPECT_EQ(values.last("out"), 1.0);
  for (int i = 0; i < 10; ++i) values.feed(90.0, 14.0, 14.0);
  ASSERT_EQ(values.alarms.size(), 2U);
  EXPECT_EQ(values.alarms[1].name, "far") << "the band sees the fail-over's value";
  for (int i = 0; i < 3; ++i) values.feed(90.0, 14.0, 20.0);
  bool told = false;
  for (const Alarm& alarm : values.alarms) {
    told = told || (alarm.name == "channel_out" && alarm.severity == Severity::invalid &&
                    alarm.ambiguity_group.size() == 2);
  }
  EXPECT_TRUE(told);
}

TEST(Voter, OfTwoRodSensorsNamesTheOneWithoutAReading) {
  PlainValues values(
      "[[voter]]\nid = 'rods'\nchannels = ['sample.rod_1_m', 'sample.rod_2_m']\n"
      "tolerance = 1.0\nconfirm_s = 3.0\nreturn_s = 5.0\nstride_s = 10.0\n");
  const auto feed = [&](config::signals::Quality second, int times) {
    for (int i = 0; i < times; ++i) {
      config::signals::Sample s;
      s.tick = values.tick++;
      s.y_m = 10.0;
      s.rod_count = 2;
      s.rod_m = {10.0, 10.5};
      s.rod_quality = {config::signals::Quality::good, second};
      values.pipeline.process(s, values);
    }
  };
  feed(config::signals::Quality::good, 20);
  EXPECT_DOUBLE_EQ(values.last("value"), 10.25);
  feed(config::signals::Quality::stale, 3);
  ASSERT_EQ(values.alarms.size(), 1U);
  EXPECT_EQ(values.alarms[0].parameter, "sample.rod_2_m");
  EXPECT_DOUBLE_EQ(values.last("value"), 10.0);
}

TEST(SampleQuantity, OfRodSensorsIsMissingWhereTheyAreNot) {
  config::signals::Sample s;
  s.y_m = 1.0;
  EXPECT_TRUE(std::isnan(value_of(SampleQuantity::rod_1, s)));
  EXPECT_TRUE(std::isnan(value_of(SampleQuantity::rod_in_charge, s)));
  s.rod_count = 2;
  s.rod_in_charge = 1;
  s.rod_m = {1.0, 2.0, 3.0};
  EXPECT_EQ(value_of(SampleQuantity::rod_2, s), 2.0);
  EXPECT_TRUE(std::isnan(value_of(SampleQuantity::rod_3, s)));
  EXPECT_EQ(value_of(SampleQuantity::rod_in_charge, s), 2.0);
  EXPECT_EQ(rod_of("sample.rod_5_m"), 5U);
  EXPECT_EQ(rod_of("sample.y_m"), 0U);
  EXPECT_EQ(rod_of("period.rod_5_m"), 0U);
}

TEST(SampleQuantity, OfPressuresIsMissingWhereTheyAreNotRead) {
  config::signals::Sample s;
  EXPECT_TRUE(std::isnan(value_of(SampleQuantity::supply_pressure, s)));
  s.pressures = {7e6, 3e6, 4e6};
  EXPECT_EQ(value_of(SampleQuantity::supply_pressure, s), 7e6);
  EXPECT_EQ(value_of(SampleQuantity::pressure_in, s), 3e6);
  EXPECT_EQ(value_of(SampleQuantity::pressure_out, s), 4e6);
}

TEST(SampleQuantity, OfAnotherSensorIsNoPositionForEstimatorsButOneForBands) {
  config::signals::Sample s;
  s.y_m = 1.0;
  s.rod_changed = true;
  EXPECT_TRUE(std::isnan(usable_y_m(s)));
  EXPECT_EQ(value_of(SampleQuantity::y, s), 1.0);
}

TEST(Voter, TakesTwoOrThreeChannels) {
  EXPECT_NE(refusal("[[voter]]\nid = 'r'\ntolerance = 1.0\nchannels = ['sample.y_m']\n")
                .find("two or three"),
            std::string::npos);
}

}  // namespace
}  // namespace estimator::fdi
