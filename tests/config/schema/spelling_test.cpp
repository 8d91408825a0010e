#include "config/schema/spelling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/schema/error.h"

namespace config::schema {
namespace {

const std::vector<std::string> kOptions{"--json", "--report", "--repeat", "--holdout"};

std::string objection(const std::vector<std::string>& words) {
  try {
    require_known_options(words, kOptions, "fit: ");
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(Nearest, FindsOneTypoAndLeavesStrangersAlone) {
  const std::vector<std::string> names{"friction", "deadband", "null_bias"};
  EXPECT_EQ(nearest("fricton", names), "friction");
  EXPECT_EQ(nearest("nul_bias", names), "null_bias");
  EXPECT_EQ(nearest("zzz", names), "");
}

TEST(RequireKnownOptions, AcceptsKnownOptionsAndValues) {
  EXPECT_EQ(objection({"m.toml", "-o", "-1.5", "--json", "x", "--report=a.html"}), "");
  EXPECT_EQ(objection({"--json", "x", "--", "--unknown"}), "") << "values after --";
}

TEST(RequireKnownOptions, NamesTheNearestOption) {
  EXPECT_EQ(objection({"--jsno", "-"}), "fit: option --jsno is unknown, did you mean --json?");
  EXPECT_EQ(objection({"--heldout=r.csv"}),
            "fit: option --heldout is unknown, did you mean --holdout?");
  EXPECT_EQ(objection({"--xyzzyplugh"}), "fit: option --xyzzyplugh is unknown");
}

TEST(RequireKnownOptions, NamesEveryOptionThatBeginsAlike) {
  EXPECT_EQ(objection({"--rep"}),
            "fit: option --rep is unknown, did you mean --report or --repeat?");
}

}  // namespace
}  // namespace config::schema
