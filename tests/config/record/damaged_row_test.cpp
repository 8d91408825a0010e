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
  EXPECT_EQ(read(names + "Scale,0.001,1\n" + kRows).t_s.size(), 3U);
  // nor is a row that was commented out
  EXPECT_EQ(read(names + "#0,error,0.1\n" + kRows).t_s.size(), 3U);
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
