#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/config/record/csv_text.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::expect_bad;
using record_test::kRows;
using record_test::read;
using record_test::TemporaryFile;
using testing::Contains;
using testing::ElementsAre;

TEST(Csv, ConvertsUnitsOnceAndKeepsFurtherColumnsByName) {
  const Record record = read(
      "t_ms,u_V,y_mm,ref_mm,supply_psi,tank_bar,case_kPa,force_norm\n"
      "0,1.5,305,306,1000,1,2,0.25\n"
      "5,-1.5,305.5,307,1001,1,2,nan\n"
      "10,0,+306,308,1002,1,2,\n");
  EXPECT_DOUBLE_EQ(record.sample_time_s, 0.005);
  EXPECT_THAT(record.t_s, ElementsAre(0.0, 0.005, 0.01));
  EXPECT_THAT(record.u_V, ElementsAre(1.5, -1.5, 0.0));
  EXPECT_THAT(record.y_m, ElementsAre(0.305, 0.3055, 0.306));
  ASSERT_EQ(record.further.size(), 5U);
  EXPECT_DOUBLE_EQ(record.column("ref_m")->at(1), 0.307);
  EXPECT_DOUBLE_EQ(record.column("supply_Pa")->at(0), 6894757.293168361);
  EXPECT_DOUBLE_EQ(record.column("tank_Pa")->at(0), 1e5);
  EXPECT_DOUBLE_EQ(record.column("case_Pa")->at(0), 2e3);
  EXPECT_DOUBLE_EQ(record.column("force_norm")->at(0), 0.25);
  EXPECT_TRUE(std::isnan(record.column("force_norm")->at(1)));
  EXPECT_TRUE(std::isnan(record.column("force_norm")->at(2)));
  EXPECT_EQ(record.column("force"), nullptr);
}

TEST(Csv, AcceptsWindowsLineEndsAByteOrderMarkQuotesAndColumnsInAnyOrder) {
  const Record record =
      read("\xEF\xBB\xBF\"y_m\", u_V ,t_s\r\n0.1,1,0\r\n0.2,2,1\r\n0.3,3,2\r\n\r\n");
  EXPECT_THAT(record.y_m, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(record.t_s, ElementsAre(0.0, 1.0, 2.0));
}

TEST(Csv, ListsGapsOfWholePeriods) {
  std::string text = "t_s,u_V,y_m\n";
  for (int i = 0; i < 60; ++i) {
    const int tick = i < 20 ? i : i < 40 ? i + 3 : i + 1000;
    text += std::to_string(tick * 0.005) + ",1,0\n";
  }
  const Record record = read(text);
  EXPECT_THAT(record.gaps, ElementsAre(20U, 40U));
  EXPECT_NEAR(record.sample_time_s, 0.005, 1e-9);
}

TEST(Csv, TakesTimeStampsRoundedToAMillisecond) {
  std::string text = "t_ms,u_V,y_m\n";
  for (int i = 0; i < 1000; ++i) text += std::to_string(std::lround(i * 7.7531)) + ",1,0\n";
  EXPECT_NEAR(read(text).sample_time_s, 0.0077531, 1e-6);
}

TEST(Csv, RefusesFilesWithoutData) {
  expect_bad("", "", "is empty");
  expect_bad("\n\n", "", "is empty");
  expect_bad("t_s,u_V,y_m\n", "", "no data");
  expect_bad("t_s,u_V,y_m\n0,1,2\n", ":2", "fewer than 3 samples");
  EXPECT_THROW((void)read_record("/nowhere/at/all.csv"), schema::Error);
  EXPECT_THROW((void)read_record("/tmp"), schema::Error);
}

TEST(Csv, RefusesALineCutOff) {
  expect_bad("t_s,u_V,y_m\n" + kRows + "0.015,4", ":5", "cut off");
  expect_bad("t_s,u_V,y_m\n" + kRows + "0.015,4,0.", ":5", "cut off");
  expect_bad("t_s,u_V,y_m\n0,1,0.105\n0.005,2,0.205\n0.010,3,0.305\n0.015,4,0.4", ":5", "cut off");
  expect_bad("t_s,u_V,y_m\n" + kRows + "0.015,4,", ":5", "cut off");
  EXPECT_EQ(read("t_s,u_V,y_m\n" + kRows + "0.015,4,0.4").size(), 4U);
}

TEST(Csv, RefusesWhatIsNoNumberOrNotFinite) {
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,abc,0\n", ":3", "u_V: 'abc' is no number");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,1.2.3,0\n", ":3", "is no number");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,+-1,0\n", ":3", "u_V: '+-1' is no number");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,+\u22121,0\n", ":3", "is no number");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,inf,1\n", ":3", "u_V is 'inf'");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,1e999,1\n", ":3", "u_V is '1e999'");
  expect_bad("t_s,u_V,y_m,p_bar\n0,1,0,1\n0.005,1,0,inf\n", ":3", "p_bar is 'inf'");
}

TEST(Csv, RefusesMagnitudesThatNoMachineHas) {
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,1,1e300\n", ":3", "y_m is 1e+300; allowed: magnitudes");
  expect_bad("t_s,u_V,y_mm\n0,1,0\n0.005,1,-1.1e9\n", ":3", "magnitudes up to 1e+06 m");
  expect_bad("t_s,u_mV,y_m\n0,1,0\n0.005,1e10,0\n", ":3", "u_mV is 1e+10; allowed: magnitudes");
  expect_bad("t_s,u_V,y_m,p_bar\n0,1,0,1\n0.005,1,0,1e8\n", ":3",
             "p_bar is 1e+08; allowed: magnitudes");
  const Record record = read("t_s,u_V,y_mm,count\n0,1,9e8,1e300\n0.005,1,0,2\n0.010,1,0,3\n");
  EXPECT_EQ(record.y_m[0], 9e5);
  EXPECT_EQ(record.column("count")->front(), 1e300) << "a column without a known unit has no limit";
}

TEST(Csv, RefusesRowsOfAnotherLength) {
  expect_bad("t_s,u_V,y_m\n0,1\n0.005,1,2\n", ":2", "too few fields");
  expect_bad("t_s,u_V,y_m\n0,1,2,3\n0.005,1,2\n", ":2", "4 fields");
  expect_bad("t_s,u_V,y_m\n0,1,2\n\n0.005,1,2\n", ":3", "empty line");
}

TEST(Csv, NotesACommandThatNeverChanges) {
  const Record record = read("t_s,u_V,y_m\n0,2.5,0.1\n0.005,2.5,0.2\n0.010,2.5,0.3\n");
  EXPECT_THAT(record.notes, ElementsAre("the command is 2.5 V throughout: nothing can be learned "
                                        "of its effect"));
  EXPECT_TRUE(read("t_s,u_V,y_m\n" + kRows).notes.empty());
  EXPECT_THAT(read("t_s,u_V,y_m\n0,1,0.5\n0.005,2,0.5\n0.010,3,0.5\n").notes,
              ElementsAre("the position is 0.5 m throughout"));
}

TEST(Csv, TakesRowsWithoutANumberForGaps) {
  std::string text = "t_s,u_V,y_m\n";
  for (int i = 0; i < 60; ++i) {
    const char* u = i == 20 ? "" : "1";
    const char* y = i == 40 || i == 41 ? "NaN" : i == 50 ? "#N/A" : "0.5";
    text += std::to_string(i * 0.005) + "," + u + "," + y + "\n";
  }
  const Record record = read(text);
  EXPECT_EQ(record.size(), 56U);
  EXPECT_THAT(record.gaps, ElementsAre(20U, 39U, 47U));
  EXPECT_THAT(record.notes,
              Contains("4 rows without a number in time, command or position are left out"));
  expect_bad("t_s,u_V,y_m\n0,1,\n0.005,1,\n0.01,1,\n", "", "y_m holds no number");
}

TEST(Csv, TakesALoneMinusSignForAGap) {
  for (const char* gap : {"\u2212", "\u2013", "\u2014", "-", "--", "n/a"}) {
    for (const char separator : {',', ';', '\t'}) {
      std::string text = "Time [s],Command [V],Position [m],Force [N]\n";
      for (int i = 0; i < 60; ++i) {
        const std::string cell = i % 20 == 10 ? gap : "1.5e\u22123";
        text += std::to_string(i * 0.005) + "," + cell + ",\u22120.5," + gap + "\n";
      }
      std::replace(text.begin(), text.end(), ',', separator);
      const Record record = read(text);
      EXPECT_EQ(record.size(), 57U) << gap;
      EXPECT_EQ(record.gaps.size(), 3U) << gap;
      EXPECT_DOUBLE_EQ(record.u_V.front(), 1.5e-3);
      EXPECT_DOUBLE_EQ(record.y_m.front(), -0.5);
    }
  }
  expect_bad("t_s,u_V,y_m\n0,1,1.5e\u221205\n0.1,2,1.5e\u221205\n0.2,2,1.5e\u22120", ":4",
             "is cut off");
}

TEST(Csv, RefusesTimesThatDoNotGoOnEvenly) {
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,1,0\n0.005,2,0\n0.01,1,0\n", ":4", "does not increase");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.010,1,0\n0.005,1,0\n0.01,1,0\n", ":4", "does not increase");
  expect_bad("t_s,u_V,y_m\n0,1,0\n0.005,1,0\n0.010,1,0\n0.0175,1,0\n0.0225,1,0\n", ":5",
             "unevenly sampled");
  std::string alternating = "t_s,u_V,y_m\n";
  double t_s = 0.0;
  for (int i = 0; i < 31; ++i) {
    alternating += std::to_string(t_s) + ",1,0\n";
    t_s += i % 3 == 0 ? 0.01 : 0.005;
  }
  expect_bad(alternating, ":3", "unevenly sampled");
}

TEST(Csv, RefusesHeadersThatCannotBeMeant) {
  expect_bad("u_V,y_m\n1,0\n", ":1", "lacks a time column");
  expect_bad("t_s,y_m\n1,0\n", ":1", "lacks a command column");
  expect_bad("t_s,u_V\n1,0\n", ":1", "lacks a position column");
  expect_bad("u_V,p_bar\n1,0\n", ":1", "lacks a time column; lacks a position column; it has: ");
  expect_bad("t_s,u_V,y_m,t_ms\n0,1,2,0\n", ":1", "two time columns");
  expect_bad("t_s,u_V,y_m,time_s\n0,1,2,0\n", ":1", "two time columns");
  expect_bad("t_s,u_V,y_m,y_m\n0,1,2,0\n", ":1", "has column y_m twice");
  expect_bad("t_s,u_V,y_m,y_mm\n0,1,2,0\n", ":1", "contradictory units: y_m and y_mm");
  expect_bad("t_s,u_V,y_m,p_bar,p_psi\n0,1,2,0,0\n", ":1", "contradictory units");
  expect_bad("t_s,u_V,y_bar\n0,1,2\n", ":1", "column y_bar has a contradictory unit");
  expect_bad("t_s,u_m,y_m\n0,1,2\n", ":1", "column u_m has a contradictory unit");
  expect_bad("t_V,u_V,y_m\n0,1,2\n", ":1", "column t_V has a contradictory unit");
  expect_bad("t,u_V,y_m\n0,1,2\n", ":1", "column t has no unit");
  expect_bad("0,1,2\n0.005,1,2\n", ":1", "no header that names its columns");
  expect_bad(std::string("\x7f"
                         "ELF\0\0\0\0",
                         8),
             "", "is no record");
}

TEST(Csv, RefusesAnExponentCutOff) {
  const std::string rows = "0,1,1.5e-05\n0.005,2,2.5e-05\n0.010,3,3.5e-0";
  expect_bad("t_s,u_V,y_m\n" + rows, ":4", "is cut off");
  expect_bad("t_s,u_V,y_m\n0,1,1.5\n0.005,2,2.5e", ":3", "is cut off");
  EXPECT_DOUBLE_EQ(read("t_s,u_V,y_m\n" + rows + "5\n").y_m[2], 3.5e-5);
}

TEST(Csv, NotesALastLineWithoutItsEnd) {
  EXPECT_TRUE(read("t_s,u_V,y_m\n" + kRows).notes.empty());
  const Record open = read("t_s,u_V,y_m\n" + kRows.substr(0, kRows.size() - 1));
  EXPECT_EQ(open.size(), 3U);
  ASSERT_EQ(open.notes.size(), 1U);
}

TEST(Csv, AcceptsQuotedNumbers) {
  const Record record = read("\"t_s\",\"u_V\",\"y_m\"\n\"0\",\"1\",\"2.5\"\n" + kRows.substr(8));
  EXPECT_DOUBLE_EQ(record.y_m[0], 2.5);
}

TEST(Csv, ReadsOtherSeparatorsAndDecimalCommas) {
  for (const std::string text : {"t_s;u_V;y_mm\n0;1,5;2,25\n0,005;1;2\n0,01;1;2\n",
                                 "t_s\tu_V\ty_mm\n0\t1.5\t2.25\n0.005\t1\t2\n0.01\t1\t2\n"}) {
    const Record record = read(text);
    EXPECT_THAT(record.t_s, ElementsAre(0.0, 0.005, 0.01));
    EXPECT_DOUBLE_EQ(record.u_V[0], 1.5);
    EXPECT_DOUBLE_EQ(record.y_m[0], 2.25e-3);
  }
}

TEST(Csv, EachColumnSaysWhatItsCommasAre) {
  const std::string header = "Time [s],Command [V],Position [um],Force [N]\n";
  // the command's decimals are commas by its second row, the position's groups by its third
  const Record record = read(header +
                             "0.0,\"1,250\",\"2,345\",7\n0.1,\"0,5\",\"987\",8\n"
                             "0.2,\"-2\",\"1,234.5\",9\n");
  EXPECT_THAT(record.u_V, ElementsAre(1.25, 0.5, -2.0));
  EXPECT_DOUBLE_EQ(record.y_m[0], 2345e-6);
  EXPECT_DOUBLE_EQ(record.y_m[1], 987e-6);
  EXPECT_DOUBLE_EQ(record.y_m[2], 1234.5e-6);
  // a column that is not read may have two readings
  EXPECT_EQ(read("Time [s],Command [V],Position [mm],Count\n0.0,1,2,\"1,234\"\n0.1,1,2,\"1,235\"\n"
                 "0.2,1,2,\"1,236\"\n")
                .y_m.size(),
            3U);
  expect_bad(header + "0.0,1,\"1,234\",7\n0.1,1,\"1,235\",7\n0.2,1,\"1,236\",7\n", ":2",
             "column Position [um]: '1,234' has two readings");
  // beyond the lines that tell the form
  std::string late = header;
  for (int k = 0; k < 2000; ++k) {
    late += std::to_string(0.1 * k) + ",1," +
            (k < 1500 ? std::string("999") : std::string("\"1,000\"")) + ",7\n";
  }
  expect_bad(late, ":1502", "'1,000' has two readings");
}

TEST(Csv, TakesNoCommentMarkForAColumn) {
  const std::string rows = "0 1 0.1 7\n0.005 2 0.2 7\n0.010 3 0.3 7\n";
  EXPECT_THAT(read("# t_s u_V y_m p_bar\n" + rows).y_m, ElementsAre(0.1, 0.2, 0.3));
  expect_bad("# t_s u_V y_m\n" + rows, ":2", "no header that names its columns");
}

TEST(Csv, LeavesOutAColumnWithoutAName) {
  const Record record = read(",t_s,u_V,y_m\n0,0,1,0.1\n1,0.005,2,0.2\n2,0.01,3,0.3\n");
  EXPECT_THAT(record.y_m, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_TRUE(record.further.empty());
}

TEST(Csv, SaysWhereNumbersWereNotVoltsAndMetresAndKeepsTheirUnits) {
  const Record record = read("t_s,u_mA,y_deg\n0,4,0\n0.005,12,90\n0.01,20,180\n");
  EXPECT_DOUBLE_EQ(record.u_V[1], 0.012);
  EXPECT_DOUBLE_EQ(record.y_m[2], 3.14159265358979323846);
  EXPECT_EQ(record.command_unit, "A");
  EXPECT_EQ(record.position_unit, "rad");
  EXPECT_EQ(record.notes.size(), 2U);
  EXPECT_THROW(require_volts_and_metres(record), schema::DataError);
  const TemporaryFile file("");
  write_csv(record, file.path());
  const Record again = read_record(file.path());
  EXPECT_EQ(again.u_V, record.u_V);
  EXPECT_EQ(again.command_unit, "A");
  const Record volts = read("t_s,u_V,y_m\n" + kRows);
  EXPECT_NO_THROW(require_volts_and_metres(volts));
  EXPECT_THROW(require_same_units({units_of(volts), units_of(record)}), schema::DataError);
}

TEST(Csv, KeepsMessagesShort) {
  const TemporaryFile file("t_s,u_V,y_m\n" + std::string(100'000, '1') + "\n");
  try {
    (void)read_record(file.path());
    FAIL();
  } catch (const schema::Error& error) {
    EXPECT_LT(std::string(error.what()).size(), 300U);
  }
}

TEST(Csv, TheTimeForAHeaderGrowsWithItsColumnsNotWithTheirSquare) {
  const auto seconds_of = [](int columns) {
    std::string header = "t_s,u_V,y_m";
    std::string row = ",1,0";
    for (int i = 0; i < columns; ++i) {
      header += ",c" + std::to_string(i) + "_V";
      row += ",1";
    }
    const auto worked_s = [] {
      timespec now{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    };
    const double begin_s = worked_s();
    EXPECT_EQ(read(header + "\n0" + row + "\n0.005" + row + "\n0.01" + row + "\n").further.size(),
              static_cast<std::size_t>(columns));
    return worked_s() - begin_s;
  };
  // Eight times the columns: about eight times the time; by pairs it is 64 times.
  EXPECT_LT(seconds_of(64'000), 30.0 * seconds_of(8'000));
}

TEST(Csv, WritesIntoAPipeInsteadOfReplacingIt) {
  const std::filesystem::path pipe =
      testing::TempDir() + "spoolwatch_pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  Record record = read("t_s,u_V,y_m\n" + kRows);
  write_csv(record, pipe);
  char text[12] = {};
  EXPECT_EQ(::read(reader, text, 11), 11);
  EXPECT_STREQ(text, "t_s,u_V,y_m");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  close(reader);
  std::filesystem::remove(pipe);
}

TEST(Csv, ReadsBackExactlyWhatItWrote) {
  Record record;
  record.further.emplace_back("supply_Pa", std::vector<double>{});
  for (int i = 0; i < 50; ++i) {
    record.t_s.push_back(i * 0.005);
    record.u_V.push_back(std::sin(i) / 3.0);
    record.y_m.push_back(0.305 + 1e-7 * i);
    record.further[0].second.push_back(i == 7 ? std::nan("") : 6.89e6 + i / 7.0);
  }
  const TemporaryFile file("");
  write_csv(record, file.path());
  const Record again = read_record(file.path());
  EXPECT_EQ(again.t_s, record.t_s);
  EXPECT_EQ(again.u_V, record.u_V);
  EXPECT_EQ(again.y_m, record.y_m);
  EXPECT_TRUE(std::isnan(again.column("supply_Pa")->at(7)));
  EXPECT_EQ(again.column("supply_Pa")->at(8), record.further[0].second[8]);
  EXPECT_THROW(write_csv(record, "/nowhere/at/all.csv"), schema::Error);
}

TEST(Csv, AFailedWriteLeavesTheOldFileAndNoOther) {
  const std::filesystem::path folder = testing::TempDir() + "/record_write_test";
  std::filesystem::create_directories(folder / "taken.csv" / "inside");  // cannot be replaced
  EXPECT_THROW(write_csv(Record{}, folder / "taken.csv"), schema::Error);
  const auto entries = std::distance(std::filesystem::directory_iterator(folder), {});
  EXPECT_EQ(entries, 1);
  std::filesystem::remove_all(folder);
}

TEST(Csv, ReadsTheMeasuredRecords) {
  const char* given = std::getenv("SPOOLWATCH_DATA");
  const std::filesystem::path data =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "../shared/data";
  if (!std::filesystem::exists(data / "faster/faster.csv")) {
    GTEST_SKIP() << "no measured records in " << data;
  }
  const Record faster = read_record(data / "faster/faster.csv");
  EXPECT_EQ(faster.size(), 21275U);
  EXPECT_NEAR(1.0 / faster.sample_time_s, 128.98, 0.01);
  EXPECT_TRUE(faster.gaps.empty());
  const Record emps = read_record(data / "emps/train_200Hz.csv");
  EXPECT_NEAR(emps.sample_time_s, 0.005, 1e-12);
  EXPECT_NE(emps.column("ref_m"), nullptr);
  EXPECT_NE(emps.column("F_N"), nullptr);
}

}  // namespace
}  // namespace config::record
