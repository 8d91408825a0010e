// Scales beside units, in headers and in lines above the numbers: read, or refused by name.
#include "config/record/unit_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "config/record/column_words.h"
#include "config/record/layout.h"
#include "config/record/limit_line.h"
#include "config/record/record.h"
#include "config/record/unit_text.h"
#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using record_test::expect_bad;
using record_test::kRows;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Relative rounding of a product of two decimal fractions.
constexpr double kRounding = 1e-15;

TEST(UnitScale, APowerOfTenBelowOneOrAFractionIsPartOfTheUnit) {
  for (const char* tenth : {"0.1 mm", "0,1 mm", "[0.1mm]", "1/10 mm", "1e-4 m", "10^-4 m",
                            "10\xE2\x81\xBB\xE2\x81\xB4 m", "0.1*mm"}) {
    const UnitText unit = parse_unit(tenth);
    EXPECT_EQ(unit.si, "m") << tenth;
    EXPECT_NEAR(unit.factor, 1e-4, 1e-4 * kRounding) << tenth;
  }
  EXPECT_NEAR(parse_unit("1/4096 rev").factor, parse_unit("rev").factor / 4096.0, kRounding);
  for (const char* none : {"10 mm", "0.25 mm", "500 mm", "2/3 mm", "mm*10", "1/mm", "0.1", "0.1 -"})
    EXPECT_FALSE(parse_unit(none).known()) << none;
}

TEST(UnitScale, AHeaderKeepsItsNameBeforeTheScale) {
  for (const char* header : {"Position [0.1 mm]", "Position / 0.1 mm", "Position, 0.1 mm",
                             "Position 0.1 mm", "Position in 1/10 mm", "Position_0.1mm"}) {
    const HeaderText text = parse_header(header);
    EXPECT_EQ(text.name, "Position") << header;
    EXPECT_NEAR(text.unit.factor, 1e-4, 1e-4 * kRounding) << header;
    EXPECT_FALSE(text.scaled) << header;
  }
}

TEST(UnitScale, SeveralReadingsLeaveNoUnit) {
  for (const char* header : {"Position [mm*10]",
                             "Position [mm/10]",
                             "Position [mm x10]",
                             "Position [x 0.1 mm]",
                             "Position x10 [mm]",
                             "Position x 0.1 [mm]",
                             "Position*10 [mm]",
                             "Position/10 [mm]",
                             "Position \xC3\x97"
                             "10 [mm]",
                             "Position (x10) [mm]",
                             "10 x Position [mm]",
                             "10xPosition [mm]",
                             "0.1xPosition [mm]",
                             "Position (1:10) [mm]",
                             "Position (10 : 1) [mm]",
                             "Position [mm]*0.1",
                             "Position [10 mm]",
                             "Position 0.25 mm",
                             "Position x 0.1 mm",
                             "Position 10^-1 [mm]",
                             "Position\xC2\xB7"
                             "10\xC2\xB3 [m]",
                             "Weg in Zehntel mm",
                             "Position (factor 10) [mm]"}) {
    const HeaderText text = parse_header(header);
    EXPECT_TRUE(text.scaled) << header;
    EXPECT_FALSE(text.unit.known()) << header;
  }
}

TEST(UnitScale, NumbersOfChannelsAreNoScales) {
  for (const char* header : {"Position 10 [mm]", "Position X10 [mm]", "x1 [mm]", "Max 10 [mm]",
                             "AI 1.2 [mm]", "Dev1/ai0 [mm]", "Position 2 mm", "pos_x10_mm",
                             "Rod (left) [mm]", "2xy [mm]", "Rod 1:10 [mm]"}) {
    const HeaderText text = parse_header(header);
    EXPECT_FALSE(text.scaled) << header;
    EXPECT_EQ(text.unit.si, "m") << header;
  }
  EXPECT_EQ(parse_header("Acceleration [m/s2]").unit.si, "mps2");
  EXPECT_FALSE(parse_header("Density [kg/m3]").scaled);
}

TEST(UnitScale, LongHeadersAreSoughtNoFurtherThanAUnitIsLong) {
  static std::size_t asked = 0;
  for (const char* part : {"x", " ", "/", "mm*10 ", "1/"}) {
    std::string text = "Position ";
    while (text.size() < 100'000) text += part;
    asked = 0;
    EXPECT_FALSE(has_open_scale(text + "]", [](std::string_view) { return ++asked == 0; }));
    EXPECT_LE(asked, kMostUnitBytes + 1) << part;
    EXPECT_FALSE(parse_header(text + "]").unit.known()) << part;
  }
}

TEST(UnitScale, NumbersOfStatesAreNoneBesideOthers) {
  EXPECT_EQ(column_header({"t [s]", "x1 [mm]", "x10 [mm]"}, 2, {}).name, "x10");
  EXPECT_EQ(column_header({"t [s]", "x1 [mm]", "x10 [mm]"}, 2, {}).unit.si, "m");
  EXPECT_TRUE(column_header({"t [s]", "u [V]", "x10 [mm]"}, 2, {}).scaled);
  EXPECT_TRUE(column_header({"x1 [s]", "u [V]", "y x10 [mm]"}, 2, {}).scaled);
}

TEST(UnitScale, CellsHaveNone) {
  const Record record = record_test::read(
      "t_s,u_V,y_m,p\n0,1,0.1,2.1000 bar\n0.005,2,0.2,3.0100 bar\n0.010,3,0.3,4.0010 bar\n");
  ASSERT_NE(record.column("p_Pa"), nullptr);
  EXPECT_NEAR(record.column("p_Pa")->at(1), 301000.0, 1e-6);
}

TEST(StatedFactors, AreThoseThatChangeANumber) {
  EXPECT_THAT(stated_factors({"Faktor", "1", "0,001"}, ','),
              ElementsAre("", "", "'Faktor' '0,001'"));
  EXPECT_THAT(stated_factors({"Offset:", "0", "5 mm"}, '.'),
              ElementsAre("", "", "'Offset:' '5 mm'"));
  EXPECT_THAT(stated_factors({"Gain", "1.0", ""}, '.'), ElementsAre("", "", ""));
  EXPECT_THAT(stated_factors({"max", "10", "600"}, '.'), IsEmpty());
  EXPECT_THAT(stated_factors({"Full scale", "10", "600"}, '.'), IsEmpty());
  // the screen's scale, not the values'
  EXPECT_THAT(stated_factors({"Vertical Scale", "2", "0.5"}, '.'), IsEmpty());
  EXPECT_THAT(stated_factors({"Controller gain", "2", ""}, '.'), IsEmpty());  // a setting
  for (const std::string word : {"Calibration factor", "Conversion", "Umrechnung", "LSB", "Sign",
                                 "Vorzeichen", "Zero", "Bias", "Ratio"}) {
    EXPECT_THAT(stated_factors({word, "", "0.25"}, '.'),
                ElementsAre("", "", "'" + word + "' '0.25'"));
  }
  for (const std::string word :
       {"Signal", "Duration", "Calibration date", "Zeros", "Conversion rate", "Conversion time"}) {
    EXPECT_THAT(stated_factors({word, "", "0.25"}, '.'), IsEmpty()) << word;
  }
}

TEST(StatedFactors, AreAllButOne) {
  for (const char* other : {"1/100", "10^-3", "1*10^-3",
                            "1\xC2\xB7"
                            "10\xE2\x81\xBB\xC2\xB3",
                            "1 x 10^-3", "1 000", "1:10", "/10", ".001", "div 10", "1.000,5",
                            "1 V/mm", "50 mm/V", "-1", "1 mm", "Zehntel", "1,000.5", "0"}) {
    for (const char decimal : {'.', ','}) {
      EXPECT_THAT(stated_factors({"Faktor", "1", other}, decimal),
                  ElementsAre("", "", "'Faktor' '" + std::string(other) + "'"))
          << decimal;
    }
    expect_bad(std::string("Zeit [s];Ventil [V];Weg [mm]\nFaktor;1;") + other +
                   "\n0,000;0,0;0,1\n0,005;2,3;0,2\n0,010;1,3;0,3\n",
               ":1", std::string("column Weg [mm] has 'Faktor' '") + other + "' in line 2");
  }
  for (const char* one : {"1", "1.0", "1,0", "1.000000e+00", "x 1", "*1", "1 V/V", "1 [mm/mm]",
                          "1:1", "1/1", "1 -", "", "-", "NaN"}) {
    EXPECT_THAT(stated_factors({"Faktor", "", one}, '.'), ElementsAre("", "", "")) << one;
  }
  for (const char* zero : {"0", "0.0", "-0", "0 mm", "0,000", "-"}) {
    EXPECT_THAT(stated_factors({"Offset", "", zero}, '.'), ElementsAre("", "", "")) << zero;
  }
  EXPECT_THAT(stated_factors({"Offset", "", "0 + 5 mm"}, '.'),
              ElementsAre("", "", "'Offset' '0 + 5 mm'"));
}

TEST(StatedFactors, AreNoneInNamesAndNotes) {
  const Record names = record_test::read(
      "Scale time [s];Command 1 [V];Position 2 [mm]\n0;1;0.1\n0.005;2;0.2\n0.010;3;0.3\n");
  EXPECT_THAT(names.notes, IsEmpty());
  EXPECT_THAT(stated_factors({"Verst\xC3\xA4rker", "MX440", "MX440"}, '.'), IsEmpty());
  EXPECT_THAT(stated_factors({"Calibration", "2024", "3"}, '.'), IsEmpty());
}

TEST(StatedFactors, OfNoColumnAreSaid) {
  for (const char* line :
       {"Faktor Weg;0.1", "# Faktor Weg: 0.1", "Faktor Weg = 1/10", "Faktor Weg 0.1",
        "# Offset Weg 5 mm", "Faktor;0.1;1;1;1", "Kanal 3;Faktor;Weg;0.1;x", "Faktor 0.1"}) {
    const Record record = record_test::read(
        std::string(line) + "\nZeit [s];Ventil [V];Weg [mm]\n0;0;0.1\n0.005;2;0.2\n0.01;1;0.3\n");
    EXPECT_THAT(record.notes, ElementsAre(HasSubstr(line)));
  }
}

TEST(StatedFactors, StandBehindAWordOfTheirOwnOrInItsColumn) {
  const std::string table = "\nZeit [s];Ventil [V];Weg [mm]\n0;0;0.1\n0.005;2;0.2\n0.01;1;0.3\n";
  for (const char* line : {"Faktor;1;1;0.1", "Faktor;;1;0.1", "# Faktor;1;1;0.1"}) {
    expect_bad(line + table, ":2", "column Weg [mm] has 'Faktor' '0.1' in line 1");
  }
  expect_bad("Offset;1;1;0" + table, ":2", "column Ventil [V] has 'Offset' '1' in line 1");
  for (const char* line : {"Faktor;1;1;1", "Offset;0;0;0", "Faktor Weg 1", "Offset Weg 0 mm",
                           "Channel scale;AI1;AI2", "Skala;linear;log10", "Skala;;linear;log10",
                           "Gain;Dev1/ai0;Dev1/ai1", "Gain set on Monday"}) {
    EXPECT_THAT(record_test::read(line + table).notes, IsEmpty()) << line;
  }
}

TEST(StatedFactors, MayHaveUnitsOrNoWordInFront) {
  EXPECT_THAT(stated_factors({"Faktor", "1 V/V", "50 mm/V"}, '.'),
              ElementsAre("", "", "'Faktor' '50 mm/V'"));
  EXPECT_TRUE(is_limit_line({"Faktor", "1 V/V", "50 mm/V"}, '.'));
  EXPECT_THAT(stated_factors({"", "x 1", "x 0.1"}, '.'), ElementsAre("", "", "'x 0.1'"));
  EXPECT_THAT(stated_factors({"", "X3", "X4"}, '.'), IsEmpty());
}

TEST(StatedFactors, AreRefusedUnderOwnNamesTooUntilAMappingSpeaks) {
  const std::string text = "t_s;u_V;y_m\nFaktor;1;0.001\n0;1;0.1\n0.005;2;0.2\n0.010;3;0.3\n";
  expect_bad(text, ":1", "column y_m has 'Faktor' '0.001' in line 2");
  const record_test::TemporaryFile file(text);
  ReadOptions options;
  options.map = "y=y_m*1";
  EXPECT_EQ(read_record(file.path(), options).y_m.front(), 0.1);
  options.map = "y=y_m*0.001[m]";
  EXPECT_DOUBLE_EQ(read_record(file.path(), options).y_m.front(), 1e-4);
}

TEST(LineOfUnits, MayBeLedByAWord) {
  const Record record = record_test::read(
      "Name;Zeit;Ventil;Weg\nEinheit:;s;V;mm\n1;0;1;100\n2;0.005;2;200\n3;0.010;3;300\n");
  EXPECT_DOUBLE_EQ(record.y_m.back(), 0.3);
}

TEST(FirstRow, UnitsInItsCellsAloneAreRefused) {
  expect_bad("Zeit;Ventil;Weg\n0,00 s;1,2 V;3,4 mm\n0,01;1,3;3,5\n0,02;1,4;3,6\n", ":2",
             "has units in its cells, the rows below have none");
}

TEST(Messages, AreUtf8WhateverTheFile) {
  EXPECT_EQ(record::quoted("\xDC"
                           "berlauf"),
            "'\xC3\x9C"
            "berlauf'");
  EXPECT_EQ(record::quoted(std::string(39, 'a') + "\xC3\x9C"), "'" + std::string(39, 'a') + "...'");
  const Record record =
      record_test::read("t_s;u_V;y_m\n;Verst\xE4rker;\n0;1;0.1\n0.005;2;0.2\n0.010;3;0.3\n");
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_THAT(record.notes[0], HasSubstr("Verst\xC3\xA4rker"));
}

TEST(Messages, BytesThatEncodeNoCharacterAreLatin1) {
  for (const char* bad :
       {"\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF0\x80\x80\x80", "\xC0\x80"}) {
    EXPECT_EQ(utf8_text(bad).size(), 2 * std::string_view(bad).size()) << bad;
  }
  for (const char* good :
       {"\xE0\xA0\x80", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF", "\xF0\x90\x80\x80"}) {
    EXPECT_EQ(utf8_text(good), good);
  }
}

TEST(Comments, BetweenRowsAreSaid) {
  const Record record = record_test::read("t_s,u_V,y_m\n" + kRows + "# unit now mm\n0.015,3,0.3\n");
  EXPECT_THAT(record.notes, ElementsAre(HasSubstr("line 5 '# unit now mm'")));
}

}  // namespace
}  // namespace config::record
