// How headers, units, mappings and times of foreign files are understood. Whole files of many
// programs' styles are in tests/records/styles.
#include "config/record/reading.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/record/clock_text.h"
#include "config/record/column_roles.h"
#include "config/record/outliers.h"
#include "config/record/record.h"
#include "config/record/text_fields.h"
#include "config/record/time_grid.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"
#include "tests/config/record/csv_text.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::error_of;
using record_test::read;
using record_test::TemporaryFile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(UnitText, DistinguishesPrefixesByCaseAndWordsByNone) {
  EXPECT_EQ(parse_unit("[mm]").factor, 1e-3);
  EXPECT_EQ(parse_unit("(N m)").si, "Nm");
  EXPECT_EQ(parse_unit("MPa").factor, 1e6);
  EXPECT_EQ(parse_unit("[h]").factor, 3600.0);
  EXPECT_EQ(parse_header("Time_h").unit.factor, 3600.0);
  EXPECT_EQ(parse_header("Time/min").unit.factor, 60.0);
  for (const char* other : {"y_h", "Flow l/h", "Speed km/h"})
    EXPECT_EQ(parse_header(other).unit.si, "") << other;
  EXPECT_FALSE(parse_unit("mpa").known());  // milli or mega
  EXPECT_FALSE(parse_unit("counts").known());
  EXPECT_EQ(parse_unit("SEC").si, "s");
  EXPECT_NEAR(parse_unit("1/min").factor, 2.0 * std::acos(-1.0) / 60.0, 1e-15);
  EXPECT_NEAR(parse_unit("l/min").factor, 1e-3 / 60.0, 1e-20);
  EXPECT_EQ(parse_unit("\xCE\xBCm").factor, 1e-6);  // the Greek letter
}

TEST(UnitText, OfAnAngleMayBeGerman) {
  for (const char* header : {"Winkel [Grad]", "Winkel [grad]", "Winkel in Grad", "Winkel Grad",
                             "phi_grad", "Drehwinkel / Grad"}) {
    EXPECT_EQ(parse_header(header).unit.factor, parse_unit("deg").factor) << header;
  }
  EXPECT_EQ(parse_unit("Grad/s").factor, parse_unit("deg/s").factor);
  EXPECT_EQ(parse_unit("[Umdrehung]").factor, parse_unit("rev").factor);
  EXPECT_EQ(parse_unit("Umdrehungen").si, "rad");
  for (const char* other : {"Pressure_grad", "temp grad", "Motor Umdrehungen"}) {
    EXPECT_EQ(parse_header(other).name, other);
  }
}

TEST(UnitText, FindsTheUnitInAHeader) {
  const auto parts = [](const char* header) {
    const HeaderText text = parse_header(header);
    return text.name + "|" + text.unit.si;
  };
  EXPECT_EQ(parts("Position [mm]"), "Position|m");
  EXPECT_EQ(parts("Position / mm"), "Position|m");
  EXPECT_EQ(parts("Speed m/s"), "Speed|mps");
  EXPECT_EQ(parts("v/m/s"), "v|mps");
  EXPECT_EQ(parts("Position, mm"), "Position|m");
  EXPECT_EQ(parts("Time_s_"), "Time|s");
  EXPECT_EQ(parts("Position (rod) [mm]"), "Position (rod)|m");
  EXPECT_EQ(parts("Position (rod)"), "Position (rod)|");
  EXPECT_EQ(parts("Channel A"), "Channel A|");
  EXPECT_EQ(parts("pressure_in"), "pressure_in|");  // no inches
  EXPECT_EQ(parts("Position (\")"), "Position|m");
  EXPECT_EQ(parts("Torque [lbf in]"), "Torque|Nm");
  EXPECT_EQ(parts("Torque [in lbf]"), "Torque|Nm");
  EXPECT_EQ(parts("Position [in mm]"), "Position|m");
  // NIST SP 811: 1 lbf in = 0.1129848 N m, 1 lbf ft = 1.355818 N m
  for (const char* torque : {"lbf in", "in lbf", "lbf-in", "in-lbf", "IN LBF"})
    EXPECT_NEAR(parse_unit(torque).factor, 0.1129848, 1e-7) << torque;
  for (const char* torque : {"lbf ft", "ft lbf", "lbf-ft"})
    EXPECT_NEAR(parse_unit(torque).factor, 1.355818, 1e-6) << torque;
  EXPECT_EQ(parts("y_in"), "y|m");
  EXPECT_EQ(parts("y_min"), "y_min|");  // no minutes
  EXPECT_EQ(parts("Position [counts]"), "Position|");
}

TEST(Numbers, AreReadByTheirDecimalSignOrNotAtAll) {
  double value = 0.0;
  EXPECT_TRUE(parse_number("1.234,5", ',', value));
  EXPECT_EQ(value, 1234.5);
  EXPECT_FALSE(parse_number("1.234", ',', value));  // 1234 or 1.234
  EXPECT_FALSE(parse_number("12.34,5", ',', value));
  EXPECT_FALSE(parse_number("1,", ',', value));
  EXPECT_FALSE(parse_number("1,5", '.', value));
  EXPECT_TRUE(parse_number("\u22121,5", ',', value));  // minus sign
  EXPECT_DOUBLE_EQ(value, -1.5);
  EXPECT_TRUE(parse_number("\u22121,5e\u22123", ',', value));
  EXPECT_DOUBLE_EQ(value, -1.5e-3);
  EXPECT_FALSE(parse_number("1\u22123", '.', value));
  EXPECT_FALSE(parse_number("\u2212\u22121", '.', value));
  EXPECT_TRUE(parse_number("+1.5e-3", '.', value));
  EXPECT_EQ(value, 1.5e-3);
}

TEST(Clock, CountsSecondsOfDatesAndTimes) {
  double a = 0.0;
  double b = 0.0;
  EXPECT_TRUE(parse_clock("2024-02-28T23:59:59.5", a));
  EXPECT_TRUE(parse_clock("01.03.2024 00:00:00,25", b));
  EXPECT_NEAR(b - a, 86400.0 + 0.75, 1e-6);  // 2024 has a 29th of February
  EXPECT_TRUE(parse_clock("1:02:03.5 PM", a));
  EXPECT_NEAR(a, 13 * 3600 + 2 * 60 + 3.5, 1e-9);
  // as MATLAB's writetable and pandas write them
  EXPECT_TRUE(parse_clock("28-Feb-2024 23:59:59.500", a));
  EXPECT_TRUE(parse_clock("01-Mrz-2024 00:00:00,25", b));
  EXPECT_NEAR(b - a, 86400.0 + 0.75, 1e-6);
  EXPECT_TRUE(parse_clock("1 days 00:00:01.005000", a));
  EXPECT_NEAR(a, 86401.005, 1e-9);
  EXPECT_TRUE(parse_clock("05:03.5", a));  // minutes and seconds
  EXPECT_NEAR(a, 303.5, 1e-9);
  EXPECT_TRUE(parse_clock("90:00,25", a));
  EXPECT_NEAR(a, 5400.25, 1e-9);
  EXPECT_FALSE(parse_clock("05:03", a));      // or hours and minutes
  EXPECT_TRUE(parse_clock("30:00:01.5", a));  // a duration
  EXPECT_NEAR(a, 108001.5, 1e-9);
  EXPECT_FALSE(parse_clock("2024-05-01 30:00:01", a));
  EXPECT_FALSE(parse_clock("28-Foo-2024 23:59:59", a));
  EXPECT_FALSE(parse_clock("0 daze 00:00:01", a));
  EXPECT_FALSE(parse_clock("2024-13-01 00:00:00", a));
  EXPECT_FALSE(parse_clock("12.5", a));
}

TEST(Mapping, SplitsAtCommasBeforeTheNextKeyAlone) {
  const auto pairs = parse_map("t=Time, s,u=\"Valve, u=A [V]\",y=Position [mm]");
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].column, "Time, s");
  EXPECT_EQ(pairs[1].column, "Valve, u=A [V]");
  EXPECT_EQ(pairs[2].column, "Position [mm]");
  EXPECT_THROW((void)parse_map("/nowhere/at/all"), schema::UsageError);
  EXPECT_THROW((void)parse_map("t=1,t=2"), schema::UsageError);
  EXPECT_THROW((void)parse_resample("fast"), schema::UsageError);
  EXPECT_EQ(parse_resample("250Hz"), 250.0);
}

TEST(Mapping, ScalesTurnsAndShifts) {
  const Record record = read("a;b;c\n0;1;10\n1;2;20\n2;3;30\n", "t=a[ms],u=-b*2[V],y=c*0.5-1[mm]");
  EXPECT_THAT(record.t_s, ElementsAre(0.0, 1e-3, 2e-3));
  EXPECT_THAT(record.u_V, ElementsAre(-2.0, -4.0, -6.0));
  EXPECT_THAT(record.y_m, testing::Pointwise(testing::DoubleEq(), {4e-3, 9e-3, 14e-3}));
}

TEST(Mapping, ShiftsAndScalesByNumbersWithAnExponent) {
  const std::string text = "t;u;Pos\n0;1;100\n0.01;2;200\n0.02;3;300\n";
  const auto first_y_m = [&](const std::string& term) {
    return read(text, "t=t[s],u=u[V],y=" + term).y_m[0];
  };
  EXPECT_DOUBLE_EQ(first_y_m("Pos-1e-3[m]"), 99.999);
  EXPECT_DOUBLE_EQ(first_y_m("Pos+1e-3[m]"), 100.001);
  EXPECT_DOUBLE_EQ(first_y_m("-Pos*1e-3-2e-3[m]"), -0.102);
  EXPECT_DOUBLE_EQ(first_y_m("Pos*-2e+1-1e+2[mm]"), -2.1);
  EXPECT_DOUBLE_EQ(first_y_m("- Pos - 1e2[mm]"), -0.2);
}

TEST(Mapping, RefusesASignWithoutAColumn) {
  for (const char* term : {"-", "- ", "\"-\"", "\"- \"", "--", "+", "*2", "-1e-3"}) {
    EXPECT_THAT(error_of("t;u;Pos\n0;1;100\n0.01;2;200\n0.02;3;300\n",
                         std::string("t=t[s],u=u[V],y=") + term),
                HasSubstr("--map"))
        << term;
  }
}

TEST(Mapping, LoggersOfOneClockThatBeginAtDifferentTimesStayAligned) {
  // position and command are the seconds past noon
  std::string text = "A;Pos;B;Cmd\n";
  for (int k = 0; k < 40; ++k) {
    const double a_s = 0.1 * k;
    const double b_s = 0.1 * k + 0.7;
    text += fmt::format("12:00:{:06.3f};{:.3f};12:00:{:06.3f};{:.3f}\n", a_s, a_s, b_s, b_s);
  }
  const Record record = read(text, "t=A,y=Pos[m],u=Cmd[V]@B", "10Hz");
  ASSERT_GT(record.size(), 20U);
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (std::isnan(record.u_V[k]) || record.t_s[k] < 0.75) continue;     // before the first command
    EXPECT_NEAR(record.u_V[k], record.y_m[k], 0.1001) << record.t_s[k];  // the command is held
  }
}

TEST(Mapping, NamesTheNearestColumnAndWhatTheFileHas) {
  const std::string text = "Time [s],Cmd [V],Pos [mm]\n0,1,2\n1,1,2\n2,1,2\n";
  EXPECT_THAT(error_of(text, "y=Poss"), HasSubstr("there is no column Poss, did you mean Pos"));
  EXPECT_THAT(error_of(text, "y=Pos[furlong]"), HasSubstr("the unit furlong is not known"));
  EXPECT_THAT(error_of(text, "u=Pos[V],y=Pos"), HasSubstr("--map names column Pos [mm] twice"));
  EXPECT_THAT(error_of(text, "t=Pos"), HasSubstr("column Pos [mm] has a contradictory unit"));
}

TEST(Roles, SayEverythingThatIsWrongInOneLineWithTheMappingToType) {
  const std::string error = error_of("time,voltage,pos\n0,1,305\n0.005,1,306\n0.01,1,307\n");
  EXPECT_THAT(error, HasSubstr("column time has no unit; column voltage has no unit; column pos "
                               "has no unit; it has: 1 time, 2 voltage, 3 pos; probably: --map "
                               "'t=time[s],u=voltage[V],y=pos[mm]'"));
}

TEST(Roles, ProposeAMappingThatReadsColumnsWhoseNamesAreNumbers) {
  // as oscilloscopes of Keysight write them
  const std::string text = "x-axis,1,2\nsecond,Volt,Volt\n-1e-3,1,4\n0,2,5\n1e-3,3,6\n";
  const std::string error = error_of(text);
  const std::string begin = "--map '";
  const std::size_t at = error.find(begin) + begin.size();
  const std::string map = error.substr(at, error.find('\'', at) - at);
  EXPECT_EQ(map, "t=x-axis,u=1,y=2[Volt]");
  const Record record = read(text, map);
  EXPECT_THAT(record.t_s, ElementsAre(-1e-3, 0.0, 1e-3));
  EXPECT_THAT(record.u_V, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(record.y_m, ElementsAre(4.0, 5.0, 6.0));
}

TEST(Roles, ProposeTheAxisOfAnOscilloscopeForTheTimeAndNoColumnTwice) {
  const std::string text = "x-axis,1,2\n-1e-3,1,4\n0,2,5\n1e-3,1,6\n";
  const std::string proposed = "--map 't=x-axis[s],u=1[V],y=2[mm]'";
  EXPECT_THAT(error_of(text), HasSubstr(proposed));
  for (const char* map : {"t=x-axis", "u=1", "y=2", "u=1[V],y=1[mm]", "t=x-axis[s],u=1[V],y=1[mm]"})
    EXPECT_THAT(error_of(text, map), HasSubstr(proposed)) << map;
  EXPECT_THAT(error_of("x current;1;2\n4;1;2\n5;1;2\n4;1;2\n"), Not(HasSubstr("y=x current")));
  // an axis of a machine
  EXPECT_EQ(read("Time [s],Command [V],X-Axis [mm]\n0,1,2\n1,1,3\n2,1,4\n").y_m[2], 4e-3);
}

TEST(Roles, ProposeTheRateThatTheFileStatesAndInventNone) {
  const std::string rows = "1\t10\n2\t11\n1\t12\n";
  const std::string names = "Command [V]\tPosition [mm]\n";
  EXPECT_THAT(error_of(names + rows), HasSubstr("--map 't=RATEHz,u=Command,y=Position'"));
  for (const char* stated : {"dt [s]:\t0.005\n", "Sample Rate\t200 Hz\n", "delta t:\t5 ms\n",
                             "Abtastrate [kHz]\t0.2\n", "Sample interval: 0.005\n"}) {
    EXPECT_THAT(error_of(stated + names + rows), HasSubstr("'t=0.005s,u=Command,y=Position'"))
        << stated;
  }
  // as oscilloscopes of Rigol write them: numbers of samples
  EXPECT_THAT(error_of("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1.0e+00,5.0e-03\n"
                       "0,1,10,\n1,2,11,\n2,1,12,\n"),
              HasSubstr("'t=0.005s,u=2[V],y=3[mm]'"));
}

TEST(Roles, ProposeAUnitOfAnglesForAnAngle) {
  const std::string names = "Zeit [s],Moment [Nm],";
  EXPECT_THAT(error_of(names + "Winkel\n0,1,20\n1,1,30\n2,1,20\n"), HasSubstr("y=Winkel[deg]"));
  EXPECT_THAT(error_of(names + "Winkel\n0,1,0.2\n1,1,0.3\n2,1,0.2\n"), HasSubstr("y=Winkel[rad]"));
  EXPECT_THAT(error_of(names + "Winkel [Digits]\n0,1,20\n1,1,30\n2,1,20\n"),
              HasSubstr("y=3*FACTOR[deg]"));
}

TEST(Roles, TellTheUnitOfATimeSince1970ByItsSize) {
  const auto error = [](const char* begin, const char* end) {
    std::string text = "Time,Command [V],Position [mm]\n";
    for (int k = 1; k < 5; ++k) text += begin + std::to_string(k) + end + ",1,2\n";
    return error_of(text);
  };
  EXPECT_THAT(error("171455953", "000"), HasSubstr("t=Time[ms]"));
  EXPECT_THAT(error("171455953", "000000"), HasSubstr("t=Time[us]"));
  EXPECT_THAT(error("171455953", "000000000"), HasSubstr("t=Time[ns]"));
  EXPECT_THAT(error("1335898273", "0000000"), HasSubstr("t=Time*1e-7[s]"));  // Windows
}

TEST(Roles, TakeNoReferenceForAPositionAndNoPositionForACommand) {
  const Record record =
      read("Time [s],Position command [mm],Command [V],Position [mm]\n0,1,2,3\n1,1,2,3\n2,1,2,3\n");
  EXPECT_EQ(record.y_m[0], 3e-3);
  EXPECT_EQ(record.u_V[0], 2.0);
  EXPECT_THAT(error_of("Time [s],Setpoint [mm],Command [V]\n0,1,2\n1,1,2\n2,1,2\n"),
              HasSubstr("lacks a position column"));
}

}  // namespace
}  // namespace config::record
