// Positions of -9999 and the like are gaps for whoever reads the record.
#include "config/record/missing_marks.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "config/record/record.h"
#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using record_test::error_of;
using record_test::read;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// 900 rows at 100 Hz, the position 0.3 m and more; `mark` at rows that `is_marked` tells.
template <class IsMarked>
std::string marked(const std::string& names, const std::string& mark, IsMarked is_marked) {
  std::string text = names + "\n";
  for (int k = 0; k < 900; ++k) {
    const std::string y = is_marked(k) ? mark : fmt::format("{:.4f}", 0.3 + 1e-4 * k);
    text += fmt::format("{:.2f},{},{}\n", 0.01 * k, k % 7, y);
  }
  return text;
}

bool thrice(int k) { return k == 300 || k == 301 || k == 600; }

TEST(MissingMarks, AreGapsOfTheRecord) {
  const Record record = read(marked("t_s,u_V,y_m", "-9999", thrice));
  EXPECT_EQ(record.size(), 897U);
  EXPECT_THAT(record.gaps, ElementsAre(300U, 598U));
  EXPECT_DOUBLE_EQ(record.y_m[300], 0.3302);
  EXPECT_THAT(record.notes,
              ElementsAre("-9999 m at 3 s (3 samples) marks missing values: they are gaps"));
  EXPECT_EQ(record.origins.back().missing, 3U);
  EXPECT_THAT(read(marked("Time [s],Command [V],Position [mm]", "999", thrice)).notes,
              Contains("0.999 m at 3 s (3 samples) marks missing values: they are gaps"));
}

TEST(MissingMarks, AreCountedApartFromEmptyFields) {
  const auto empty = [](int k) { return k == 100 || k == 102; };
  std::string text = marked("t_s,u_V,y_m", "", empty);
  text += "9.00,1,-9999\n9.01,1,0.4\n";
  EXPECT_THAT(read(text).notes,
              ElementsAre("-9999 m at 9 s (1 sample) marks missing values: they are gaps",
                          "2 rows without a number in time, command or position are left out"));
}

TEST(MissingMarks, AreLeftOutBeforeAnythingIsInterpolated) {
  const auto hole = [](int k) { return k == 100 || (k >= 300 && k < 310); };
  const Record record = read(marked("t_s,u_V,y_m", "-9999", hole), "", "200");
  for (const double y_m : record.y_m) EXPECT_GT(y_m, 0.29);
  EXPECT_EQ(record.gaps.size(), 1U);
  EXPECT_THAT(record.notes,
              Contains("-9999 m at 1 s (11 samples) marks missing values: they are left out"));
}

TEST(MissingMarks, AreNamedWhereTooLittleIsLeft) {
  const auto every_fifth = [](int k) { return k % 5 == 4; };
  EXPECT_THAT(error_of(marked("t_s,u_V,y_m", "-9999", every_fifth)),
              HasSubstr("-9999 m at 0.04 s (180 samples) marks missing values"));
  const auto almost_all = [](int k) { return k > 1; };
  EXPECT_THAT(error_of(marked("t_s,u_V,y_m", "-9999", almost_all)),
              HasSubstr("fewer than 3 samples; -9999 m at 0.02 s (898 samples) marks missing"));
}

TEST(MissingMarks, AreNoneWhereNoOtherPositionIs) {
  const auto all = [](int) { return true; };
  for (const char* mark : {"0.999", "-9999"}) {  // the first is a rod at rest
    const Record record = read(marked("t_s,u_V,y_m", mark, all));
    EXPECT_EQ(record.size(), 900U);
    EXPECT_THAT(record.notes, ElementsAre(fmt::format("the position is {} m throughout", mark)));
  }
  EXPECT_THAT(find_missing_marks({999.0, kNone, 9999.0}, 1.0), IsEmpty());
}

TEST(MissingMarks, AreKnownInTheUnitOfTheFile) {
  const double degree_rad = 3.14159265358979 / 180.0;
  EXPECT_THAT(find_missing_marks({10.0, -9999.0, kNone, 20.0}, degree_rad), ElementsAre(1U));
  EXPECT_THAT(find_missing_marks({0.010, 9.999, 0.020}, 1.0), ElementsAre(1U));    // mm
  EXPECT_THAT(find_missing_marks({10.0, 99999e3, 20.0}, -1e-3), ElementsAre(1U));  // m
  EXPECT_THAT(find_missing_marks({10.0, -9.0, 20.0}, degree_rad), IsEmpty());      // a position
  EXPECT_THAT(find_missing_marks({10.0, 999.0, 998.0, 20.0}, 1e-3), IsEmpty());    // among others
  EXPECT_THAT(find_missing_marks({10.0, 999.0, 101.0, 9999.0}, 1e-3), ElementsAre(3U));
}

TEST(MissingMarks, AreNoPositionsOfAFileWithoutTimes) {
  std::string text = "u_V,y_m\n";
  for (int k = 0; k < 50; ++k) text += fmt::format("{},{}\n", k, k == 20 ? "-9999" : "0.5");
  const Record record = read(text, "t=100Hz");
  EXPECT_THAT(record.gaps, ElementsAre(20U));
  EXPECT_DOUBLE_EQ(record.t_s[20], 0.21);
  EXPECT_THAT(record.notes, Contains(HasSubstr("-9999 m at 0.2 s (1 sample)")));
  EXPECT_THAT(record.notes, Not(Contains(HasSubstr("without a number"))));
}

}  // namespace
}  // namespace config::record
