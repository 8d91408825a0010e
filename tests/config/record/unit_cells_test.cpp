// Cells that carry their unit, and labels that only look like that.
#include <gmock/gmock.h>

#include <string>

#include "config/record/record.h"
#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using record_test::expect_bad;
using record_test::read;
using testing::ElementsAre;

TEST(Csv, ReadsUnitsThatStandInTheCells) {
  const Record glued = read(
      "Time,Valve,Position,Phase\n0.0s,12.5%,3.2mm,1A\n0.1s,-12.5%,3.3mm,1B\n0.2s,0%,3.4mm,1C\n");
  EXPECT_THAT(glued.t_s, ElementsAre(0.0, 0.1, 0.2));
  EXPECT_THAT(glued.u_V, ElementsAre(12.5, -12.5, 0.0));
  EXPECT_EQ(glued.command_unit, "pct");
  EXPECT_DOUBLE_EQ(glued.y_m[2], 3.4e-3);
  EXPECT_TRUE(glued.further.empty()) << "names such as 1A, 1B are no amperes";
  // decimal commas; no-break spaces before the unit
  const Record german = read(
      "Zeit;Ventil;Weg\n0,0\xC2\xA0s;4,5\xC2\xA0V;1.234,5 mm\n0,1\xC2\xA0s;4,5\xC2\xA0V;3,2 mm\n"
      "0,2\xC2\xA0s;-4,5\xC2\xA0V;3,2 mm\n");
  EXPECT_THAT(german.u_V, ElementsAre(4.5, 4.5, -4.5));
  EXPECT_DOUBLE_EQ(german.y_m[0], 1.2345);
  // in quotes between commas
  const Record quoted = read(
      "Time,Valve,Position\n\"0,0 s\",\"4,5 V\",\"3,25 mm\"\n\"0,1 s\",\"4,5 V\",\"3,2 mm\"\n"
      "\"0,2 s\",\"4,5 V\",\"3,2 mm\"\n");
  EXPECT_DOUBLE_EQ(quoted.y_m[0], 3.25e-3);
  // one column alone, the header agrees; a missing cell
  const Record one =
      read("t_s,u_V,y_mm\n0,4.5 V,\n0.1,4.5 V,3.2 mm\n0.2,4 V,3.2 mm\n0.3,4 V,3 mm\n");
  EXPECT_EQ(one.size(), 3U);
  EXPECT_EQ(one.u_V.back(), 4.0);
  // blanks around separators are no columns
  EXPECT_EQ(read("t_s ; u_V ; y_m\n0 ; 1 ; 2\n1 ; 1 ; 2\n2 ; 1 ; 2\n").size(), 3U);
}

TEST(Csv, CarriesTheUnitOfItsCellsIntoAFurtherColumnBesideTheOwnNames) {
  const Record cells = read("t_s,u_V,y_m,p\n0,1,2,50 bar\n1,1,2,51 bar\n2,1,2,52 bar\n");
  ASSERT_NE(cells.column("p_Pa"), nullptr);
  EXPECT_THAT(*cells.column("p_Pa"), ElementsAre(50e5, 51e5, 52e5));
  const Record line =
      read("t_s;u_V;y_m;p;i_mA\ns;V;m;bar;mA\n0;1;2;50;4\n1;1;2;51;5\n2;1;2;52;6\n");
  ASSERT_NE(line.column("p_Pa"), nullptr);
  EXPECT_EQ(line.column("p_Pa")->at(2), 52e5);
  ASSERT_NE(line.column("i_A"), nullptr);
  EXPECT_DOUBLE_EQ(line.column("i_A")->at(2), 6e-3);
  const std::string rows = "0;1;2;50\n1;1;2;51\n2;1;2;52\n";
  // port A, no current
  const Record port = read("t_s;u_V;y_m;p_A\ns;V;m;bar\n" + rows);
  ASSERT_NE(port.column("p_A_Pa"), nullptr);
  EXPECT_EQ(port.column("p_A_Pa")->at(2), 52e5);
  expect_bad("t_s;u_V;y_m;p\ns;mV;m;bar\n" + rows, ":1", "column u_V names two units, V and mV");
  expect_bad("t_s;u_V;y_m;p_kPa\ns;V;m;bar\n" + rows, ":1", "p_kPa names two units, kPa and bar");
  expect_bad("t_s;u_V;y_m;i_mA\ns;V;m;A\n" + rows, ":1", "column i_mA names two units, mA and A");
  expect_bad("t_s,u_V,y_m,p,p_bar\n0,1,2,50 bar,1\n1,1,2,51 bar,1\n2,1,2,52 bar,1\n", ":1",
             "contradictory units: p and p_bar");
}

TEST(Csv, TakesCellsWithAUnitButNoNumberForGaps) {
  for (const std::string gap : {"NaN mm", "nanmm", "-- mm", "--mm", "- mm", "n/a\xC2\xA0mm"}) {
    SCOPED_TRACE(gap);
    const std::string begin = "Time;Valve;Position\n0 s;1 V;3 mm\n1 s;1 V;4 mm\n2 s;1 V;";
    const Record record = read(begin + gap + "\n3 s;1 V;5 mm\n4 s;1 V;6 mm\n");
    EXPECT_THAT(record.y_m, ElementsAre(3e-3, 4e-3, 5e-3, 6e-3));
    EXPECT_EQ(record.gaps.size(), 1U);
    // the first cell, and a column of numbers without units
    EXPECT_EQ(read("t_s,u_V,y_mm\n0,1," + gap + "\n1,1,2\n2,1,2\n3,1,2\n").size(), 3U);
  }
  expect_bad("t_s,u_V,y_mm\n0,1,2\n1,1,NAm\n2,1,2\n", ":3", "'NAm' is no number");
}

// Settings and names: hardly two values, and never zero.
TEST(Csv, LeavesLabelsThatLookLikeUnitsOut) {
  std::string text = "t_s,u_V,y_mm,Phase,Supply\n";
  for (int k = 0; k < 40; ++k) {
    text += std::to_string(k) + ",1.5,3.2," + (k % 2 == 0 ? "1A," : "2A,") +
            (k < 30 ? "24V\n" : "off\n");
  }
  const Record labelled = read(text);
  EXPECT_EQ(labelled.size(), 40U);
  EXPECT_TRUE(labelled.further.empty());
  // a measurement comes through zero, or has many values
  std::string measured = "t_s,u_V,y_mm,Load\n";
  for (int k = 0; k < 40; ++k)
    measured += std::to_string(k) + ",1.5,3.2," + (k < 30 ? "0N\n" : "5N\n");
  EXPECT_EQ(read(measured).further.size(), 1U);
}

TEST(Csv, RefusesUnitsInCellsThatContradictOneAnotherOrTheHeader) {
  const std::string rows = "0;4.5 V;3.2 mm\n0.1;4.5 V;3.2 mm\n";
  expect_bad(
      "Time [s];Valve;Position\n" + rows + "0.2;4.5 V;3 cm\n", ":4",
      "column Position: '3 cm' is in cm, the cells before are in mm; allowed: the same unit");
  expect_bad("Time [s];Valve;Position\n" + rows + "0.2;4.5;3 mm\n", ":4",
             "column Valve: '4.5' has no unit, the cells before are in V");
  expect_bad("Time [s];Valve [V];Position [mm]\n0;0;3\n0.1;4.5 V;3\n0.2;4.5 V;3\n", ":3",
             "column Valve [V]: '4.5 V' is in V, the cells before have no unit");
  expect_bad("Time [s];Valve [V];Position [cm]\n" + rows + "0.2;4.5 V;3 mm\n", ":2",
             "column Position [cm]: '3.2 mm' is in mm, the column's name says cm");
  expect_bad("t_s,u_V,y_m\n0,1 V,2 m\n1,1 V,2 m\n2,1 V,2 mm\n", ":4", "'2 mm' is in mm");
  expect_bad("t_s,u_V,y_mm\n0,1 V,2 m\n1,1 V,2 m\n2,1 V,2 m\n", ":2", "column's name says mm");
  expect_bad("Time;Valve;Position\n0 s;error;3 mm\n1 s;4 V;3 mm\n2 s;4 V;3 mm\n", ":2",
             "column Valve: 'error' is no number");
  // beyond the lines that tell the form
  std::string late = "Time [s];Valve;Position [mm]\n";
  for (int k = 0; k < 1200; ++k) {
    late += std::to_string(k) + ';' + std::to_string(k % 5) + (k < 1150 ? " %;3\n" : " mV;3\n");
  }
  expect_bad(late, ":1152", "column Valve: '0 mV' is in mV, the cells before are in %");
}

}  // namespace
}  // namespace config::record
