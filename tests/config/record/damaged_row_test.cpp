// Rows whose first line is damaged are refused, headers never.
#include <gmock/gmock.h>

#include <string>

#include "config/record/record.h"
#include "tests/config/record/csv_text.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::expect_bad;
using record_test::kRows;
using record_test::read;
using record_test::TemporaryFile;

TEST(Csv, RefusesAFirstRowThatOneFieldDamages) {
  const std::string names = "Time [s],Command [V],Position [mm]\n";
  expect_bad(names + "0,error,0.1\n0.005,2,0.2\n0.010,3,0.3\n", ":2",
             "column Command [V]: 'error' is no number");
  expect_bad("0,error,0.1\n0.005,2,0.2\n0.010,3,0.3\n", ":1", "column 2: 'error' is no number");
  // a row of words, or of scales that have words before them, is none
  EXPECT_EQ(read(names + "measured,commanded,measured\n" + kRows).t_s.size(), 3U);
  EXPECT_EQ(read(names + "Scale,1,1.0\n" + kRows).t_s.size(), 3U);
  // nor is a row that was commented out
  EXPECT_EQ(read(names + "#0,error,0.1\n" + kRows).t_s.size(), 3U);
}

TEST(Csv, RefusesAFirstRowThatSeveralFieldsDamage) {
  const std::string names = "Time [s],Command [V],Position [mm]\n";
  expect_bad(names + "0,OL,OL\n" + kRows, ":2", "column Command [V]: 'OL' is no number");
  expect_bad(names + "-0.005,foo,bar\n" + kRows, ":2", "column Command [V]: 'foo' is no number");
  expect_bad(names + "OL,OL,0.1\n" + kRows, ":2", "column Time [s]: 'OL' is no number");
  expect_bad(names + "OL,1,0.1\n" + kRows, ":2", "column Time [s]: 'OL' is no number");
  expect_bad(names + "0,OL,OL\n0.001,OL,OL\n0.002,1,0.1\n0.003,1,0.1\n0.004,1,0.1\n", ":2",
             "'OL' is no number");
  // without names, where its number leads to those below
  expect_bad("0,foo,bar\n1,1,0.1\n2,2,0.2\n3,2,0.2\n4,2,0.2\n", ":1", "'foo' is no number");
  // amid rows, where it might pass for names
  std::string rows = names;
  for (int k = 0; k < 60; ++k) {
    rows += k == 20 ? "this,and,that\n" : std::to_string(k) + "," + std::to_string(k % 7) + ",2\n";
  }
  expect_bad(rows, ":22", "column 1: 'this' is no number");
  const std::string dates =
      "2024-12-01 10:00:00,1,0.1\n2024-12-01 10:00:01,1,0.1\n2024-12-01 10:00:02,1,0.1\n";
  const std::string what = "column Time: '2024-13-01 10:00:00' is no date and time";
  expect_bad("Time,Command [V],Position [mm]\n2024-13-01 10:00:00,1,0.1\n" + dates, ":2", what);
  expect_bad("Time,Command [V],Position [mm]\n2024-13-01 10:00:00,OL,0.1\n" + dates, ":2", what);
}

TEST(Csv, NotesLinesBetweenNamesAndNumbersThatAreNoRows) {
  const std::string rows = "0;1;0.1\n0.005;2;0.2\n0.010;3;0.3\n0.015;3;0.3\n";
  const auto notes = [&](const std::string& above) {
    const Record record = read(above + rows);
    EXPECT_EQ(record.size(), 4U) << above;
    EXPECT_DOUBLE_EQ(record.y_m[0], 1e-4) << above;
    return record.notes.empty() ? "" : record.notes.back();
  };
  const std::string begin = "left out, neither names nor a row: ";
  const std::string names = "Time;Command;Position\n";
  const std::string units = "s;V;mm\n";
  EXPECT_EQ(notes(names + units), "");
  EXPECT_EQ(notes(names + units + "min;-10;-100\nmax;10;100\n"),
            begin + "line 3 'min;-10;-100', line 4 'max;10;100'");
  EXPECT_EQ(notes("sep=;\n" + names + units + "min;-10;-100\n"), begin + "line 4 'min;-10;-100'");
  EXPECT_EQ(notes(names + "min;-10;-100\n" + units), begin + "line 2 'min;-10;-100'");
  for (const char* ranges :
       {"[0..5];[-10..10];[-100..100]", "0..5;-10..10;-100..100", "0 to 5;-10 to 10;0 - 600",
        ";+/-10;\xC2\xB1 100", "Range;[-10, 10];", "Scale;1;1", "1;channel 2;channel 3",
        ";valve amplifier, X3;rod sensor, X4"}) {
    EXPECT_EQ(notes(names + units + ranges + "\n"), begin + "line 3 '" + ranges + "'");
  }
  EXPECT_EQ(notes("Time [s];Command [V];Position [mm]\nmin;-10;-100\n"),
            begin + "line 2 'min;-10;-100'");
}

TEST(Csv, NotesLabelsBelowTheNamesWhereTimesBeginLate) {
  std::string rows;
  for (int k = 0; k < 20; ++k) rows += std::to_string(5.0 + 0.005 * k) + ";1;0.1\n";
  const std::string names = "Time [s];Command [V];Position [mm]\n";
  for (const char* labels : {"1;CH1;CH2", "0;valve;rod", "X1;CH1;CH2", "2.5;1st;2nd"}) {
    const Record record = read(names + labels + "\n" + rows);
    EXPECT_EQ(record.size(), 20U);
    EXPECT_THAT(record.notes, testing::Contains("left out, neither names nor a row: line 2 '" +
                                                std::string(labels) + "'"));
  }
  // a few steps before the first row, or words of a damaged field
  expect_bad(names + "4.98;CH1;CH2\n" + rows, ":2", "column Command [V]: 'CH1' is no number");
  expect_bad(names + "1;OL;OL\n" + rows, ":2", "column Command [V]: 'OL' is no number");
}

TEST(Csv, TakesARowWithARangeForNoLineOfLimits) {
  const std::string rows = "0.005;1;0.1\n0.010;2;0.2\n0.015;3;0.3\n0.020;3;0.3\n";
  const std::string names = "Time [s];Command [V];Position [mm]\n";
  for (const char* first : {"0;1;0..35", "0;1;0 - 35", "3;1;0..35"}) {
    expect_bad(names + first + "\n" + rows, ":2", "column Position [mm]: '0");
    expect_bad(first + ("\n" + rows), ":1", "column 3: '0");
  }
  expect_bad(names + "0;0..10;0..35\n" + rows, ":2", "column Command [V]: '0..10' is no number");
  expect_bad("t_s,u_V,y_m\n0,1,0..35\n" + kRows, ":2", "column y_m: '0..35' is no number");
}

TEST(Csv, NotesLimitsWhereNothingNamesTheColumns) {
  ReadOptions options;
  options.map = "t=1[s],u=2[V],y=3[mm]";
  const TemporaryFile file("0..10;-10..10;0..35\n0;1;0.1\n0.005;2;0.2\n0.010;3;0.3\n");
  const Record record = read_record(file.path(), options);
  EXPECT_EQ(record.size(), 3U);
  EXPECT_THAT(record.notes, testing::Contains("left out, neither names nor a row: line 1 "
                                              "'0..10;-10..10;0..35'"));
  // below the own names, too
  const Record own = read("t_s,u_V,y_m\nmin,-10,0\n" + kRows);
  EXPECT_EQ(own.size(), 3U);
  EXPECT_THAT(own.notes,
              testing::Contains("left out, neither names nor a row: line 2 'min,-10,0'"));
}

TEST(Csv, TakesATitleOfAsManyFieldsForNoNames) {
  const std::string rows = "0,1,0.1\n0.005,2,0.2\n0.010,3,0.3\n";
  for (const char* title :
       {"Test 12,Rig A,2024-05-01", "Test 12,Rig A,140 bar", "10 s,24 V,Pump 140 bar",
        "Test 12,2024-05-01,10:32:11", "12,17,2024-05-01"}) {
    for (const char* names : {"Time,Command,Position\ns,V,mm\n", "t_s,u_V,y_mm\n",
                              "Time [s],Command [V],Position [mm]\n"}) {
      const Record record = read(title + ("\n" + std::string(names)) + rows);
      EXPECT_EQ(record.size(), 3U) << title << names;
      EXPECT_DOUBLE_EQ(record.y_m[0], 1e-4) << title << names;
    }
  }
  expect_bad("Test 12,Rig A,Pump 140 bar\ntime,valve,pos\n" + rows, ":2",
             "'t=time[s],u=valve[V],y=pos[m]'");
}

TEST(Csv, RefusesWordsInPlaceOfTimeCommandOrPosition) {
  expect_bad("t_s;u_V;y_m\n0;on;2\n1;off;2\n2;on;2\n", ":1", "column u_V holds text, not numbers");
  expect_bad("t_s;u_V;y_m\n0;1;x\n1;1;x\n2;1;x\n", ":1", "column y_m holds text, not numbers");
}

TEST(Csv, RefusesADamagedFirstRowOfTwoColumns) {
  const auto read_command = [](const std::string& content, const char* map = "") {
    ReadOptions options;
    options.position_optional = true;
    options.map = map;
    return read_record(TemporaryFile(content).path(), options);
  };
  const auto refused = [&](const std::string& content, const std::string& what,
                           const char* map = "") {
    try {
      (void)read_command(content, map);
      ADD_FAILURE() << "accepted: " << content;
    } catch (const schema::DataError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  const std::string names = "Time [s],Command [V]\n";
  const std::string rows = "0.005,2\n0.010,3\n0.015,3\n";
  const char* by_number = "t=1[s],u=2[V]";
  for (const char* field : {"error", "1.x5", "***", "word"}) {
    const std::string what = "'" + std::string(field) + "' is no number";
    refused(names + "0," + field + "\n" + rows, ":2: column Command [V]: " + what);
    refused(std::string("0,") + field + "\n" + rows, ":1: column 2: " + what, by_number);
    if (std::string(field) == "word") continue;  // begins a line of words, too
    refused(names + field + ",2\n" + rows, ":2: column Time [s]: " + what);
    refused(field + std::string(",2\n") + rows, ":1: column 1: " + what, by_number);
    expect_bad("Time [s],Command [V],Position [mm]\n" + std::string(field) + ",1,2\n" + kRows, ":2",
               "column Time [s]: " + what);
  }
  // command and position, without times
  const std::string pairs = "Command [V],Position [mm]\n";
  const std::string values = "1.6,2\n1.5,3\n1.7,3\n";
  refused(pairs + "1.5,error\n" + values, ":2: column Position [mm]: 'error' is no number",
          "t=200Hz");
  refused(pairs + "1.5.5,2\n" + values, ":2: column Command [V]: '1.5.5' is no number", "t=200Hz");
  // lines of names, units, scales, counts and dates are none
  for (const char* header :
       {"x-axis,A\nsecond,Volt\n", "Time [s],Command [V]\nScale,0.001\n", "Samples,500\n",
        "Sample Interval,0.005\nTIME,CH1\n", "01.05.2024,12\n", "2024-05-01,12\n", "X,CH1\n1st,2\n",
        "Model,MDO3024\nVertical Units,V\nTIME,2B\n", "time,A\n", "5V,12V\n", "10:11:12,5\n"}) {
    EXPECT_EQ(read_command(header + rows, by_number).size(), 3U) << header;
  }
}

}  // namespace
}  // namespace config::record
