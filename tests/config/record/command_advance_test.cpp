// Commands that are logged with the other sign, or at another time than they act at.
#include "config/record/command_advance.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// u = 1, 2, ... V and y = 0.1 u at 200 Hz, with a gap of two samples after the fourth.
const std::string kWithGap =
    "t_s,u_V,y_m,ref_m\n0,1,0.1,1\n0.005,2,0.2,2\n0.01,3,0.3,3\n0.015,4,0.4,4\n"
    "0.03,7,0.7,7\n0.035,8,0.8,8\n0.04,9,0.9,9\n";

Record read(const ReadOptions& options) {
  return read_record(record_test::TemporaryFile(kWithGap).path(), options);
}

TEST(CommandAdvance, OfWholeSamplesLeavesOutWhatHasNoCommand) {
  ReadOptions options;
  options.advance_command_s = 0.01;
  const Record earlier = read(options);
  EXPECT_THAT(earlier.u_V, ElementsAre(3, 4, 9));
  EXPECT_THAT(earlier.y_m, ElementsAre(0.1, 0.2, 0.7));
  EXPECT_THAT(earlier.t_s, ElementsAre(0.0, 0.005, 0.03));
  EXPECT_THAT(*earlier.column("ref_m"), ElementsAre(1, 2, 7));
  EXPECT_THAT(earlier.gaps, ElementsAre(2));
  EXPECT_FALSE(earlier.command_is_interpolated);
  EXPECT_THAT(earlier.notes, testing::Contains(HasSubstr("taken 10 ms earlier than logged")));
  options.advance_command_s = -0.01;
  const Record later = read(options);
  EXPECT_THAT(later.u_V, ElementsAre(1, 2, 7));
  EXPECT_THAT(later.y_m, ElementsAre(0.3, 0.4, 0.9));
}

TEST(CommandAdvance, LeavesOutASegmentThatIsShorter) {
  ReadOptions options;
  options.advance_command_s = -0.015;
  EXPECT_EQ(record_test::read(kWithGap).gaps.size(), 1U);
  try {
    (void)read(options);
    ADD_FAILURE() << "one sample is no record";
  } catch (const schema::UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--advance -0.015: leaves nothing of "));
  }
  options.advance_command_s = 1e9;
  EXPECT_THROW((void)read(options), schema::UsageError);
}

// The mean of t^3 over an interval is the difference of t^4 / 4 at its ends.
TEST(CommandAdvance, OfAPartOfASampleTakesTheMeanOfACubicExactly) {
  for (const double lead : {0.25, 0.45, 1.5, -0.75}) {
    std::vector<double> u_V(16);
    for (std::size_t k = 0; k < u_V.size(); ++k) u_V[k] = std::pow(static_cast<double>(k) - 3.0, 3);
    advance_command(u_V, lead);
    EXPECT_TRUE(interpolates(lead));
    for (const std::size_t k : {3U, 6U, 9U, 12U}) {
      const double middle = static_cast<double>(k) - 3.0 + lead;
      const double mean = (std::pow(middle + 0.5, 4) - std::pow(middle - 0.5, 4)) / 4.0;
      EXPECT_NEAR(u_V[k], mean, 1e-9 * std::abs(mean)) << lead << ' ' << k;
    }
  }
}

TEST(CommandAdvance, OfAPartOfASampleIsNoted) {
  ReadOptions options;
  options.advance_command_s = 0.00125;
  const Record earlier = read(options);
  EXPECT_TRUE(earlier.command_is_interpolated);
  EXPECT_EQ(earlier.size(), 7U);
  EXPECT_NEAR(earlier.u_V[1], 2.25, 1e-12);
}

TEST(CommandAdvance, IsNotInterpolatedWhereDecimalsMissASampleByRounding) {
  EXPECT_FALSE(interpolates(0.05 / 0.005));
  EXPECT_FALSE(interpolates(-0.15 / 0.005));
  EXPECT_TRUE(interpolates(0.001 / 0.005));
  // as six digits state 8 samples at 150 Hz and 1 at 60 Hz
  EXPECT_FALSE(interpolates(0.0533333 * 150.0));
  EXPECT_FALSE(interpolates(0.0166667 * 60.0));
}

TEST(CommandAdvance, FlipTurnsTheCommandAlone) {
  ReadOptions options;
  options.flip_command = true;
  const Record turned = read(options);
  EXPECT_THAT(turned.u_V, ElementsAre(-1, -2, -3, -4, -7, -8, -9));
  EXPECT_EQ(turned.y_m.front(), 0.1);
  EXPECT_THAT(turned.notes, testing::Contains(HasSubstr("--flip")));
}

}  // namespace
}  // namespace config::record
