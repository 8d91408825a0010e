// Names and units of the columns beside time, command and position.
#include <gmock/gmock.h>

#include <string>

#include "config/record/record.h"
#include "tests/config/record/csv_text.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::expect_bad;
using record_test::read;
using record_test::TemporaryFile;
using testing::HasSubstr;

/// Three rows that begin with 0, 1, 2 and end with `cells`.
std::string rows_with(const std::string& cells) {
  std::string text;
  for (const char* time : {"0", "1", "2"}) text += time + (",1,2," + cells) + "\n";
  return text;
}

Record read_mapped(const std::string& text, const std::string& map) {
  ReadOptions options;
  options.map = map;
  return read_record(TemporaryFile(text).path(), options);
}

double first_of(const Record& record, const char* name) {
  const auto* const column = record.column(name);
  return column == nullptr ? -1.0 : column->front();
}

TEST(FurtherColumns, BesideTheOwnNamesHaveTheUnitsOfTheirHeaders) {
  const Record record = read(
      "t_s,u_V,y_m,Supply pressure [bar],p_A [bar],Setpoint [mm],Flow (l/min),Load / N,P_bar_,i_mA,"
      "Gain [-]\n" +
      rows_with("50,60,7,6,5,4,3,2"));
  EXPECT_DOUBLE_EQ(first_of(record, "Supply_pressure_Pa"), 50e5);
  EXPECT_DOUBLE_EQ(first_of(record, "p_A_Pa"), 60e5);
  EXPECT_DOUBLE_EQ(first_of(record, "reference_m"), 7e-3);
  EXPECT_DOUBLE_EQ(first_of(record, "Flow_m3ps"), 1e-4);
  EXPECT_DOUBLE_EQ(first_of(record, "Load_N"), 5.0);
  EXPECT_DOUBLE_EQ(first_of(record, "P_Pa"), 4e5);
  EXPECT_DOUBLE_EQ(first_of(record, "i_mA"), 3.0) << "an ending that is part of the name";
  EXPECT_DOUBLE_EQ(first_of(record, "Gain [-]"), 2.0);
}

TEST(FurtherColumns, HaveEachNameOnce) {
  const Record record = read("t_s,u_V,y_m,Setpoint 1 [mm],Setpoint 2 [mm],A B [bar],A_B_bar\n" +
                             rows_with("1,2,3,4"));
  EXPECT_DOUBLE_EQ(first_of(record, "reference_m"), 1e-3);
  EXPECT_DOUBLE_EQ(first_of(record, "Setpoint_2_m"), 2e-3);
  EXPECT_DOUBLE_EQ(first_of(record, "A_B_Pa"), 4e5);
  EXPECT_DOUBLE_EQ(first_of(record, "A_B_Pa_2"), 3e5);
  expect_bad("t_s,u_V,y_m,p [bar],p_bar\n" + rows_with("1,2"), ":1",
             "contradictory units: p [bar] and p_bar");
  expect_bad("t_s,u_V,y_m,y [mm]\n" + rows_with("1"), ":1", "contradictory units: y_m and y [mm]");
}

TEST(FurtherColumns, MayAloneHaveAUnitInTheLineOfUnits) {
  for (const char* names : {"t_s,u_V,y_m,supply", "Time [s],Command [V],Position [m],supply"}) {
    for (const char* units : {",,,bar", "s,V,m,bar", "-,-,-,[bar]"}) {
      const Record record = read(names + ("\n" + std::string(units)) + "\n" + rows_with("50"));
      EXPECT_EQ(record.size(), 3U) << units;
      EXPECT_DOUBLE_EQ(first_of(record, "supply_Pa"), 50e5) << names << units;
    }
  }
  expect_bad("t_s,u_V,y_m,p\ns,mV,m,bar\n" + rows_with("50"), ":1",
             "column u_V names two units, V and mV; allowed: one unit, or the right one in --map: "
             "'KEY=u_V[mV]'");
  EXPECT_EQ(read_mapped("t_s,u_V,y_m\ns,mV,m\n0,1,2\n1,1,2\n2,1,2\n", "u=u_V[mV]").u_V[0], 1e-3);
  EXPECT_EQ(read("t_s,u_V,y_m\n1,1,1\n2,1,2\n3,1,2\n").size(), 3U) << "1 is no unit there";
}

TEST(FurtherColumns, OfPortsAndPhasesAreNotInAmperes) {
  const std::string begin = "Time [s],Command [V],Position [mm],";
  const auto unit_of = [](const Record& record, const char* name) {
    for (const ChannelOrigin& origin : record.origins) {
      if (origin.name == name) return origin.unit;
    }
    return std::string("none");
  };
  const Record ports = read(begin + "p_A,x_A,x_B,i_A,i_V,i_W\n" + rows_with("1,2,3,4,5,6"));
  EXPECT_EQ(unit_of(ports, "p_A"), "");
  EXPECT_EQ(unit_of(ports, "x_A"), "");
  EXPECT_EQ(unit_of(ports, "i_A"), "A");
  EXPECT_EQ(unit_of(ports, "i_V"), "");
  // what stands beside the name, in a line or in the cells
  EXPECT_DOUBLE_EQ(
      first_of(read("Time,Command,Position,p_A,p_B\ns,V,mm,bar,bar\n" + rows_with("50,60")),
               "p_A_Pa"),
      50e5);
  EXPECT_DOUBLE_EQ(first_of(read(begin + "p_A\n" + rows_with("50 bar")), "p_A_Pa"), 50e5);
  EXPECT_DOUBLE_EQ(first_of(read("t_s,u_V,y_m,q_A\n" + rows_with("6 l/min")), "q_A_m3ps"), 1e-4);
  expect_bad("Time,u_V,Position\ns,A,mm\n0,1,2\n1,1,2\n2,1,2\n", ":1", "u_V names two units");
}

TEST(FurtherColumns, AMappingSaysWhichOfTwoUnitsIsRight) {
  const std::string text = "Time [s],Command [V],Position [mm]\ns,V,cm\n0,1,2\n1,1,2\n2,1,2\n";
  expect_bad(text, ":1",
             "column Position [mm] names two units, mm and cm; allowed: one unit, or the right one "
             "in --map: 'KEY=Position[mm]'");
  EXPECT_EQ(read_mapped(text, "y=Position[mm]").y_m[0], 2e-3);
  EXPECT_EQ(read_mapped(text, "y=Position[cm]").y_m[0], 2e-2);
}

TEST(FurtherColumns, KeepASettingWithAUnit) {
  const auto text = [](const std::string& header, const auto& cell, int count = 40) {
    std::string all = header + "\n";
    for (int k = 0; k < count; ++k) {
      all += std::to_string(k) + "," + std::to_string(k % 3) + ",2," + cell(k) + "\n";
    }
    return all;
  };
  const auto constant = [](int) { return "50 bar"; };
  for (const char* header : {"t_s,u_V,y_mm,supply", "Time [s],Command [V],Position [mm],supply"}) {
    EXPECT_DOUBLE_EQ(first_of(read(text(header, constant)), "supply_Pa"), 50e5) << header;
  }
  const char* own = "t_s,u_V,y_mm,supply";
  EXPECT_EQ(first_of(read(text(own, [](int) { return "24V"; })), "supply_V"), 24.0);
  EXPECT_DOUBLE_EQ(
      first_of(read(text(own, [](int k) { return k % 2 ? "51 bar" : "50 bar"; })), "supply_Pa"),
      50e5);
  // a word far below: no reason to refuse the file
  const Record late = read(text(
      own, [](int k) { return k < 1500 ? "24V" : "off"; }, 2000));
  EXPECT_EQ(late.size(), 2000U);
  EXPECT_TRUE(late.further.empty());
  EXPECT_THAT(late.notes,
              testing::Contains(HasSubstr("left out, not all numbers: supply (line 1502)")));
  // a setting is a command where nothing else is, and no rival of one
  EXPECT_EQ(
      read(text("Time [s],Command [V],Position [mm],Valve", [](int) { return "24V"; })).u_V[1],
      1.0);
}

TEST(FurtherColumns, APositionAtRestIsAPosition) {
  const auto text = [](const std::string& names, const std::string& rest, const char* unit) {
    std::string all = names + "\n";
    for (int k = 0; k < 200; ++k) {
      all += std::to_string(0.01 * k) + "," + std::to_string(k % 3) + "," +
             (k < 80 ? rest : std::to_string(k) + ".5") + unit + "\n";
    }
    return all;
  };
  const std::string foreign = "Time [s],Valve [V],Position";
  // times and command without units: the proposed mapping leaves the cells their own
  expect_bad(text("time,valve,pos", "NaN", " mm"), ":1", "'t=time[s],u=valve[V],y=pos'");
  expect_bad(text("time,valve,pos", "0.1", " mm"), ":1", "'t=time[s],u=valve[V],y=pos'");
  for (const char* rest : {"12.5", "12", "NaN", "--"}) {
    for (const char* unit : {" mm", "mm"}) {
      EXPECT_DOUBLE_EQ(read(text(foreign, rest, unit)).y_m.back(), 0.1995) << rest << unit;
      EXPECT_DOUBLE_EQ(read(text("t_s,u_V,y", rest, unit)).y_m.back(), 0.1995) << rest << unit;
    }
  }
}

TEST(FurtherColumns, OfTwoUnitsAreRefusedUnlessTheEndingIsAPort) {
  for (const char* name : {"p_bar", "x_mm", "supply_pressure_bar"}) {
    const std::string unit = std::string(name) == "x_mm" ? "bar" : "mm";
    const std::string text =
        "t_s,u_V,y_m," + std::string(name) + "\ns,V,m," + unit + "\n" + rows_with("3");
    expect_bad(text, ":1", "names two units");
  }
}

TEST(FurtherColumns, ASettingThatTurnsToAnotherUnitFarBelowIsRefused) {
  std::string text = "t_s,u_V,y_m,supply\n";
  for (int k = 0; k < 400; ++k) {
    text += std::to_string(0.005 * k) + ",1.5,0.25," + (k < 350 ? "50 bar" : "5 MPa") + "\n";
  }
  expect_bad(text, ":352", "is in MPa");
}

// A file that begins at rest is no other than one that does not.
TEST(FurtherColumns, ACommandAtRestStaysARivalOfTheCommand) {
  for (const char* first : {"2.5000 V", "2.4000 V"}) {
    std::string text = "Time [s],Valve command,Drive current [A],Position [m]\n";
    for (int k = 0; k < 200; ++k) {
      const std::string command =
          k < 100 ? (k % 2 == 0 ? "2.5000 V" : first) : std::to_string(0.01 * k) + " V";
      text += std::to_string(0.005 * k) + "," + command + ",1." + std::to_string(k) + ",0.1" +
              std::to_string(k) + "\n";
    }
    expect_bad(text, ":1", "the command may be");
  }
}

TEST(FurtherColumns, AnUnknownUnitLeavesTheOthersOfItsLine) {
  expect_bad("t_s;u_V;y_m;T\ns;V;cm;°C\n0;1;2;41\n1;2;3;41\n", ":1", "m and cm");
  expect_bad("t [s];u [V];y [mm];T\ns;V;cm;degC\n0;1;2;41\n1;2;3;41\n", ":1", "mm and cm");
  const Record record =
      read("Zeit;Ventil;Weg;Temp\nms;V;mm;°C\n0;1;200;41\n5;2;300;41\n10;2;310;41\n");
  EXPECT_DOUBLE_EQ(record.y_m.front(), 0.2);
}

TEST(FurtherColumns, AGapInAnotherUnitIsRefused) {
  std::string text = "Time [s],Command [V],Position [m],p [Pa]\n";
  text += "0,1,0.1,50\n0.005,2,0.2,NaN bar\n0.01,3,0.3,52\n";
  expect_bad(text, "", "a gap is in bar, the column in Pa");
}

}  // namespace
}  // namespace config::record
