#include "config/units/quantity.h"
#include "workbench/compare/comparison_report.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/workbench/compare/servo_record.h"
#include "workbench/present/compare_units.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

using compare_test::kGain;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

validation::Comparison compared(const compare_test::Fault& fault) {
  return validation::compare(compare_test::servo(),
                             greybox::dataset_of(compare_test::servo_record(fault, 30.0, 2e-6)));
}

TEST(Words, SayThatNothingIsLeftAtTheNoiseFloor) {
  const Words said = words(compared(compare_test::healthy));
  EXPECT_EQ(said.judgement, Judgement::at_floor);
  EXPECT_EQ(said.verdict, "At the noise floor: nothing left to explain.");
}

TEST(Words, NameABiasAsAConstantSpeedWithItsSign) {
  const Words out = words(compared([](double, double, double) { return 0.002; }));
  EXPECT_THAT(out.verdict,
              StartsWith("Off by a constant speed: the rod drifts 2 mm/s towards extension"));
  EXPECT_THAT(out.lines, Contains(StartsWith("Beyond that it is at the noise floor")));
  EXPECT_THAT(out.lines, Contains(HasSubstr("2 mm/s faster than the model while extending, 2 mm/s "
                                            "slower while retracting")));
  const Words in = words(compared([](double, double, double) { return -0.002; }));
  EXPECT_THAT(in.verdict, HasSubstr("2 mm/s towards retraction"));
}

TEST(Words, NameAGainWithItsSign) {
  const Words less = words(compared([](double, double u, double) { return -0.03 * kGain * u; }));
  EXPECT_THAT(less.verdict,
              AnyOf(HasSubstr("moves 3 % less"), HasSubstr("moves 3.0"), HasSubstr("moves 2.9")));
  EXPECT_THAT(less.verdict, HasSubstr("less than the model"));
}

TEST(Words, NameASignThatIsTurned) {
  const Words said = words(compared([](double, double u, double) { return -2.0 * kGain * u; }));
  EXPECT_THAT(said.verdict, HasSubstr("moves the other way than the model"));
  EXPECT_THAT(said.verdict, HasSubstr("the sign of the command or of the position is turned"));
}

TEST(Words, BlameNoSignWhereTheCommandDrivesTheMotion) {
  validation::Comparison c = compared([](double, double u, double) { return -2.0 * kGain * u; });
  c.response.correlation = 0.3;  // as of an axis on a spring
  EXPECT_THAT(words(c).verdict,
              HasSubstr("so no sign is turned: the model lacks something large, such "
                        "as a spring"));
  c.response.correlation = -0.3;
  EXPECT_THAT(words(c).verdict, HasSubstr("such as a spring, or a sign is turned"));
}

TEST(Words, NameAFactorOfAThousandAndAShiftedClock) {
  const auto record = [] { return compare_test::servo_record(compare_test::healthy, 30.0, 2e-6); };
  EXPECT_THAT(notes(compared(compare_test::healthy)), IsEmpty());
  auto large = record();
  for (double& y_m : large.y_m) y_m *= 1000.0;
  EXPECT_THAT(notes(validation::compare(compare_test::servo(), greybox::dataset_of(large))),
              Contains(HasSubstr("times as far as the model")));
  auto early = record();
  early.u_V.erase(early.u_V.end() - 20, early.u_V.end());
  early.y_m.erase(early.y_m.begin(), early.y_m.begin() + 20);
  early.t_s.resize(early.y_m.size());
  const validation::Comparison shifted =
      validation::compare(compare_test::servo(), greybox::dataset_of(early));
  EXPECT_THAT(notes(shifted), Contains(HasSubstr("before the command that drives it")));
  EXPECT_THAT(words(shifted).verdict, StartsWith("Probably misread"));
}

TEST(Words, DoNotAskForTheUnitOfALongAxisThatTheModelFollows) {
  validation::Comparison c = compared([](double, double u, double) { return -0.03 * kGain * u; });
  for (double& y_m : c.record.y_m) y_m *= 1000.0;
  c.stroke_m = 0.0;
  EXPECT_THAT(words(c).verdict, HasSubstr("less than the model"));
  EXPECT_THAT(notes(c), Not(Contains(HasSubstr("more than a stand's stroke"))));
  c.motion.ratio = 1000.0;
  EXPECT_THAT(words(c).verdict, StartsWith("Probably misread"));
}

TEST(Words, NameAPositionThatIsTurnedOutOfItsStroke) {
  validation::Comparison c = compared([](double, double u, double) { return -2.0 * kGain * u; });
  c.stroke_m = 10.0;
  EXPECT_THAT(words(c).verdict, Not(StartsWith("Probably misread")));
  for (double& y_m : c.record.y_m) y_m -= 5.0;
  EXPECT_THAT(words(c).verdict, StartsWith("Probably misread"));
  EXPECT_THAT(notes(c), testing::ElementsAre(HasSubstr("only when turned")));
}

TEST(Words, NameTheRangeThatFails) {
  const Words said = words(compared([](double t, double u, double) {
    return t > 15.0 && t < 20.0 ? 0.01 * std::sin(40.0 * t) + 0.0 * u : 0.0;
  }));
  EXPECT_EQ(said.judgement, Judgement::fails_somewhere);
  EXPECT_THAT(said.verdict, StartsWith("Fails from 15 to 20 s: "));
}

TEST(Words, CallWhatFollowsNothingADisturbance) {
  const Words said =
      words(compared([](double t, double, double) { return 0.003 * std::sin(45.9 * t); }));
  EXPECT_EQ(said.judgement, Judgement::fails_throughout);
  EXPECT_THAT(said.verdict, HasSubstr("like a disturbance"));
  EXPECT_THAT(said.lines, Contains(HasSubstr("yet independent of the command")));
  const Words slower = words(compared([](double, double u, double) { return -0.03 * u; }));
  EXPECT_THAT(slower.verdict, Not(HasSubstr("disturbance")));
}

TEST(Where, ReadsAsPeopleSpeak) {
  EXPECT_EQ(present::where(validation::RegionRange{"speed", 0.0, 0.005, "", true, false}),
            "below 5 mm/s");
  EXPECT_EQ(present::where(validation::RegionRange{"speed", 0.1, 0.3, "", false, true}),
            "above 100 mm/s");
  EXPECT_EQ(present::where(validation::RegionRange{"speed", 0.005, 0.02, "", false, false}),
            "between 5 and 20 mm/s");
  EXPECT_EQ(present::where(validation::RegionRange{"v", -0.3, -0.1, "", true, false}),
            "retracting faster than 100 mm/s");
  EXPECT_EQ(present::where(validation::RegionRange{"v", 0.1, 0.3, "", false, true}),
            "extending faster than 100 mm/s");
  EXPECT_EQ(present::where(validation::RegionRange{"u", 2.0, 9.0, "", false, true}),
            "at commands above 2 V");
  EXPECT_EQ(present::where(validation::RegionRange{"y", 0.1, 0.2, "", false, false}),
            "at positions from 100 to 200 mm");
  EXPECT_EQ(present::where(validation::RegionRange{"time", 5.0, 10.0, "", false, false}),
            "from 5 to 10 s");
  EXPECT_EQ(
      present::where(validation::RegionRange{"direction", 0.0, 0.0, "reversing", false, false}),
      "while reversing");
}

TEST(Units, GiveThreeDigitsAndNoExponents) {
  EXPECT_EQ(config::units::length_words(2.456e-6), "2.46 um");
  EXPECT_EQ(config::units::length_words(381.2e-6), "381 um");
  EXPECT_EQ(config::units::length_words(1.706e-3), "1.71 mm");
  EXPECT_EQ(config::units::length_words(1.234), "1.23 m");
  EXPECT_EQ(config::units::length_words(std::nan("")), "-");
  EXPECT_EQ(present::percent(0.0042), "under 1 %");
  EXPECT_EQ(present::percent(0.9987), "over 99 %");
  EXPECT_EQ(config::units::chance_words(1e-9), "< 1e-6");
}

TEST(Text, FitsATerminalAndIsAsciiWhereAskedFor) {
  const validation::Comparison c =
      compared([](double, double u, double) { return u > 0.5 ? 0.003 : 0.0; });
  for (const bool all : {false, true}) {
    std::string text = to_text(c, false, all);
    EXPECT_THAT(text, HasSubstr("noise floor"));
    std::size_t from = 0;
    while (from < text.size()) {
      const std::size_t to = text.find('\n', from);
      EXPECT_LE(to - from, 90U) << text.substr(from, to - from);
      from = to + 1;
    }
    for (const char letter : text) EXPECT_TRUE(letter == '\n' || (letter >= ' ' && letter <= '~'));
  }
}

}  // namespace
}  // namespace workbench::compare
