// Records from MAT files that SciPy wrote (mat/make_files.py).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::TemporaryFile;
using testing::EndsWith;
using testing::HasSubstr;

const std::string kFolder = std::string(SPOOLWATCH_SOURCE_DIR) + "/tests/config/record/mat/";

std::string content_of(const std::string& name) {
  std::ifstream in(kFolder + name + ".mat", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Record read(const std::string& name) { return read_record(kFolder + name + ".mat"); }

/// The message after the file's name; exit 65; one line.
std::string error_of(const std::filesystem::path& file) {
  try {
    (void)read_record(file);
  } catch (const schema::DataError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    EXPECT_EQ(what.find(file.string() + ":"), 0U) << what;
    return what.substr(std::min(what.size(), file.string().size() + 2));
  }
  return "no error";
}

/// The motion that make_files.py computes.
void expect_the_motion(const Record& record) {
  ASSERT_EQ(record.size(), 20U);
  EXPECT_NEAR(record.sample_time_s, 0.005, 1e-12);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const auto k = static_cast<double>(i);
    EXPECT_DOUBLE_EQ(record.t_s[i], k * 0.005);
    EXPECT_NEAR(record.u_V[i], std::sin(k * 0.2), 5e-7);  // rounded to 6 decimals
    EXPECT_DOUBLE_EQ(record.y_m[i], (305.0 + k * 0.25) * 1e-3);
  }
  EXPECT_TRUE(record.gaps.empty());
}

TEST(Mat, ReadsRowsAndColumnsPackedAndPlainInEitherByteOrder) {
  for (const char* name : {"rows", "columns", "big_endian"}) {
    SCOPED_TRACE(name);
    const Record record = read(name);
    expect_the_motion(record);
    EXPECT_TRUE(record.notes.empty());
  }
}

TEST(Mat, ConvertsWhateverTypeOfNumber) {
  const Record record = read("types");
  ASSERT_EQ(record.size(), 20U);
  EXPECT_DOUBLE_EQ(record.t_s[19], 0.095);
  EXPECT_NEAR(record.u_V[7], std::sin(1.4), 1e-6);
  EXPECT_DOUBLE_EQ(record.y_m[19], 0.019);
  EXPECT_EQ(record.column("on")->at(9), 0.0);
  EXPECT_EQ(record.column("on")->at(10), 1.0);
}

TEST(Mat, TakesTheFieldsOfTheOneStructureWithATime) {
  const Record record = read("structure");
  expect_the_motion(record);
  EXPECT_DOUBLE_EQ(record.column("supply_Pa")->at(0), 6894757.293168361);
}

TEST(Mat, NotesWhatItLeavesOutAndKeepsMissingValues) {
  const Record record = read("workspace");
  expect_the_motion(record);
  ASSERT_EQ(record.further.size(), 1U);
  EXPECT_TRUE(std::isnan(record.column("force_N")->at(3)));
  EXPECT_EQ(record.column("force_N")->at(4), 1.0);
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_THAT(record.notes[0], EndsWith(": gain, table, note, parts"));
}

TEST(Mat, SaysWhatIsWrongWithAVariable) {
  const auto error = [](const char* name) { return error_of(kFolder + name + ".mat"); };
  EXPECT_THAT(error("complex"), HasSubstr("variable u_V is complex; allowed: vectors of real"));
  EXPECT_THAT(error("matrix"), HasSubstr("variable y_mm is 10 x 2;"));
  EXPECT_THAT(error("lengths"), HasSubstr("variable u_V has 19 values, but t_s has 20"));
  EXPECT_THAT(error("text"), HasSubstr("variable t_s is of type text"));
  EXPECT_THAT(error("empty"), HasSubstr("variable u_V is 0 x 0"));
  EXPECT_THAT(error("no_unit"), HasSubstr("variable t has no unit; it has: t, u_V, y_mm; probably: "
                                          "--map 't=t[s],u=u_V,y=y_mm'"));
  EXPECT_THAT(error("two_structures"), HasSubstr("several structures with a time, a and b"));
  EXPECT_EQ(error("no_position"),
            "variable pos has no unit; it has: t_s, u_V, pos; probably: --map "
            "'t=t_s,u=u_V,y=pos[mm]'");
}

TEST(Mat, SaysInOneLineHowToSaveWhatIsInMatlabsObjects) {
  const auto error = [](const char* name) { return error_of(kFolder + name + ".mat"); };
  const std::string why = ", whose layout in a file MATLAB does not document; ";
  EXPECT_EQ(error("timeseries"),
            "u and y are objects (timeseries)" + why +
                "in MATLAB: t = u.Time; u = squeeze(u.Data); y = squeeze(y.Data); "
                "save(\"vectors.mat\", \"t\", \"u\", \"y\")");
  EXPECT_EQ(error("one_timeseries"),
            "y is an object (timeseries)" + why +
                "in MATLAB: t = y.Time; y = squeeze(y.Data); save(\"vectors.mat\", \"t\", \"y\")");
  EXPECT_THAT(
      error("timetable"),
      HasSubstr(
          "log is an object (timetable)" + why +
          "in MATLAB: log.t_s = seconds(log.Properties.RowTimes - log.Properties.RowTimes(1));"
          " writetable(timetable2table(log, \"ConvertRowTimes\", false), \"log.csv\")"));
  const Record record = read("beside_objects");
  expect_the_motion(record);
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_THAT(record.notes[0], HasSubstr("left out: log is an object (timeseries)"));
}

TEST(Mat, TakesSamplesWithoutANumberForGaps) {
  const Record record = read("nan");
  EXPECT_EQ(record.size(), 19U);
  EXPECT_THAT(record.gaps, testing::ElementsAre(3U));
}

TEST(Mat, ReadsWhatAMappingSays) {
  ReadOptions options;
  options.map = "t=t[s],y=y_mm";
  expect_the_motion(read_record(kFolder + "no_unit.mat", options));
  options.map = "t=a.t_s,u=a.u_V,y=b.y_mm";
  expect_the_motion(read_record(kFolder + "two_structures.mat", options));
}

TEST(Mat, NamesTheOtherFormatsOfMatlabAndOctave) {
  const auto error = [](const std::string& head) {
    return error_of(TemporaryFile(head + std::string(200, '\0')).path());
  };
  EXPECT_THAT(error("MATLAB 7.3 MAT-file, Platform: GLNXA64"), HasSubstr("version 7.3 (HDF5)"));
  EXPECT_THAT(error("# Created by Octave 7.3.0"), HasSubstr("Octave's text format; allowed: ver"));
  EXPECT_THAT(error_of(kFolder + "version_4.mat"), HasSubstr("is no record"));
}

TEST(Mat, RefusesEveryCutOfAFile) {
  for (const char* name : {"rows", "columns", "structure", "big_endian"}) {
    const std::string whole = content_of(name);
    const std::size_t last = std::string(name) == "structure" ? 30 : 8;
    for (std::size_t size = 1; size < whole.size(); size += 3) {
      const TemporaryFile file(whole.substr(0, size));
      const std::string error = error_of(file.path());
      EXPECT_NE(error, "no error") << name << " " << size;
      if (size >= 140 && size + last < whole.size()) {
        EXPECT_THAT(error, testing::AnyOf(HasSubstr("is cut off"), HasSubstr("lacks a")))
            << name << " " << size;
      }
    }
  }
}

TEST(Mat, SurvivesEveryDamagedByte) {
  for (const char* name : {"rows", "columns", "structure", "big_endian"}) {
    const std::string whole = content_of(name);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const char damage : {'\xFF', '\x00', '\x0E'}) {
        std::string content = whole;
        content[at] = damage;
        const TemporaryFile file(content);
        // Some bytes are values and comments, most are lengths and types: either outcome is one.
        (void)error_of(file.path());
      }
    }
  }
}

// The check sum at the end of each packed variable tells.
TEST(Mat, RefusesEveryFlippedBitOfItsPackedVariables) {
  const std::string whole = content_of("columns");
  const Record right = read("columns");
  constexpr std::size_t kFirstPacked = 128 + 8;
  for (std::size_t byte = kFirstPacked; byte < whole.size(); byte += 3) {
    std::string damaged = whole;
    damaged[byte] = static_cast<char>(damaged[byte] ^ 1 << byte % 8);
    const TemporaryFile file(damaged);
    if (error_of(file.path()) != "no error") continue;
    // A bit that pads the packed bytes changes nothing.
    const Record record = read_record(file.path());
    EXPECT_EQ(record.y_m, right.y_m) << "byte " << byte;
    EXPECT_EQ(record.u_V, right.u_V) << "byte " << byte;
    EXPECT_EQ(record.t_s, right.t_s) << "byte " << byte;
  }
}

TEST(Mat, WritesAsCsvWhatItReadToTheLastDigit) {
  const Record record = read("types");
  const TemporaryFile file("");
  write_csv(record, file.path());
  const Record again = read_record(file.path());
  EXPECT_EQ(again.t_s, record.t_s);
  EXPECT_EQ(again.u_V, record.u_V);
  EXPECT_EQ(again.y_m, record.y_m);
}

}  // namespace
}  // namespace config::record
