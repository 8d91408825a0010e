#include "workbench/present/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "workbench/present/script_json.h"

namespace workbench::present {
namespace {

TEST(Text, HtmlLeavesNoMarkup) {
  EXPECT_EQ(present::html(R"(<b a="1" c='2'>R&D</b>)"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;R&amp;D&lt;/b&gt;");
}

TEST(Text, UnitsAndAccentsPassUnchanged) { EXPECT_EQ(present::html("5 µm, ±2 °"), "5 µm, ±2 °"); }

TEST(Text, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(present::html("a\xff"
                          "b"),
            "a\xef\xbf\xbd"
            "b");
  EXPECT_TRUE(nlohmann::json::accept(present::json_string("a\xc3")));
}

TEST(Text, AJsonStringCannotCloseItsScript) {
  const std::string evil = "</script><!-- \"quoted\" \\ \n\t";
  const std::string text = present::json_string(evil);
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text).get<std::string>(), evil);
}

TEST(Text, NumbersAreShortAndKeepSevenDigits) {
  EXPECT_EQ(present::json_number(0.005), "0.005");
  EXPECT_EQ(present::json_number(-12.0), "-12");
  EXPECT_EQ(present::json_number(1.0 / 3.0), "0.3333333");
  EXPECT_EQ(present::json_number(6.02214076e23), "6.022141e+23");
}

TEST(Text, UnitsAndSignsAreTypeset) {
  EXPECT_EQ(present::typeset("27.1 um -> 2.5 um."), "27.1 µm → 2.5 µm.");
  EXPECT_EQ(present::typeset("144 +- 3 N s2/m2, N s/m"), "144 ± 3 N·s²/m², N·s/m");
  EXPECT_EQ(present::typeset("38.5 um/s, 9.9 cm3, 0.5 m/s2"), "38.5 µm/s, 9.9 cm³, 0.5 m/s²");
  EXPECT_EQ(present::typeset("um"), "µm");
  EXPECT_EQ(present::typeset("-97.65 to -50 (-1)"), "−97.65 to −50 (−1)");
  EXPECT_EQ(present::typeset("89 % of 100 %"), "89\u00a0% of 100\u00a0%");
}

TEST(Text, NamesAreNotTypeset) {
  for (const char* name : {"dead_volume_m3", "dead_volume_m3^0.049", "m2.toml", "rig-m3", "1e-06",
                           "album", "null_bias.offset_V", "run m3.csv", "first-half"}) {
    EXPECT_EQ(present::typeset(name), name);
  }
}

TEST(Text, WhatIsNoNumberIsNull) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(present::json_numbers({1.0, std::nan(""), infinity, -infinity, 2.0}),
            "[1,null,null,null,2]");
  EXPECT_EQ(present::json_numbers({}), "[]");
}

}  // namespace
}  // namespace workbench::present
