// Exports read by programs that know nothing of ours: SciPy, Python's json, Foxglove's MCAP reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/pipeline.h"
#include "workbench/cli/export.h"

namespace workbench::exchange {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::string kReaders = SPOOLWATCH_SOURCE_DIR "/tests/workbench/exchange/";

struct Result {
  int exit_code;
  std::string output;
};

Result run(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::string output;
  std::array<char, 512> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) {
    output.append(part.data(), n);
  }
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

/// By the first Python that has what it needs: exit code 77 says that it has not.
Result run_python(const std::string& arguments) {
  const Result first = run("python3 " + kReaders + arguments);
  return first.exit_code == 77 ? run("/usr/bin/python3 " + kReaders + arguments) : first;
}

class FormatsTest : public testing::Test {
 protected:
  FormatsTest() {
    std::string name = (fs::temp_directory_path() / "formats-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~FormatsTest() override { fs::remove_all(folder_); }

  /// 20 samples from tick 100 on, two estimates that name different quantities, an alarm that comes
  /// and goes.
  [[nodiscard]] std::string log() const {
    monitor::io::Recorder recorder({.folder = folder_ / "log"}, 3, false);
    monitor::io::Publisher publisher({.url = ""}, 3, 0.005, &recorder);
    for (int tick = 0; tick < 20; ++tick) {
      config::signals::Sample sample;
      sample.tick = tick + 100;
      sample.utc_us = (tick + 100) * 5000;
      sample.y_m = 0.1 + 1e-3 * tick;
      sample.u_applied_V = 2.5 * tick / 3.0;
      sample.reference_m = tick == 0 ? kNaN : 0.25;
      publisher.sample(sample);
    }
    for (const int k : {0, 1}) {
      const estimator::fdi::EstimatedValue values[] = {
          {"b1", k == 0 ? 2e-4 : 3e-4, 1e-6, 1.9e-4, k == 0 ? kNaN : 2.1e-4},
          {"a1", -1.0, kNaN, kNaN, kNaN}};
      estimator::fdi::EstimateEvent event{};
      event.source = "period";
      event.tick = 100 + k;
      event.valid = k == 0;
      event.begin_values = std::begin(values);
      event.end_values = std::begin(values) + (k == 0 ? 2 : 1);
      publisher.estimate(event, {(100 + k) * 5000, 0});
    }
    for (const bool active : {true, false}) {
      estimator::fdi::Alarm alarm;
      alarm.source = "period";
      alarm.name = "b1_low";
      alarm.severity = active ? estimator::fdi::Severity::major : estimator::fdi::Severity::ok;
      alarm.active = active;
      alarm.value = 1.5e-4;
      alarm.tick = 101;
      if (active)
        alarm.reason =
            "b1 is low, 20 \xC2\xB0"
            "C";
      publisher.alarm(alarm, false, {101 * 5000, 0});
    }
    return folder_ / "log" / "spoolwatch-3-00000.lcmlog";
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

TEST_F(FormatsTest, MatIsReadBySciPyToTheLastBit) {
  const std::string input = log();
  cli::export_log(input, folder_ / "out.mat");
  cli::export_log(input, folder_ / "out.csv");
  const Result result = run_python("read_mat.py " + (folder_ / "out.mat").string() + " " +
                                   (folder_ / "out.csv").string());
  if (result.exit_code == 77) GTEST_SKIP() << "python3-scipy is not installed";
  EXPECT_EQ(result.output, "good\n");
}

TEST_F(FormatsTest, MatReadsBackAsTheSameRecord) {
  const std::string input = log();
  cli::export_log(input, folder_ / "out.mat");
  const auto from_log = config::record::read_record(input);
  const auto from_mat = config::record::read_record(folder_ / "out.mat");
  EXPECT_EQ(from_mat.t_s, from_log.t_s);
  EXPECT_EQ(from_mat.u_V, from_log.u_V);
  EXPECT_EQ(from_mat.y_m, from_log.y_m);
  ASSERT_EQ(from_mat.further.size(), from_log.further.size());
  EXPECT_EQ(from_mat.column("state")->at(3), from_log.column("state")->at(3));
  ASSERT_EQ(from_mat.notes.size(), 1U);
  EXPECT_THAT(from_mat.notes[0], HasSubstr("estimates, alarms"));
}

TEST_F(FormatsTest, ARecordGoesThroughEveryFormat) {
  const std::string csv = folder_ / "in.csv";
  std::ofstream(csv) << "t_ms,u_V,y_mm,supply_bar\n0,1,305,100\n5,2,306,\n10,3,307,102\n";
  cli::export_log(csv, folder_ / "out.mat");
  const auto record = config::record::read_record(folder_ / "out.mat");
  EXPECT_DOUBLE_EQ(record.y_m[1], 0.306);
  EXPECT_DOUBLE_EQ(record.column("supply_Pa")->at(0), 1e7);
  cli::export_log(folder_ / "out.mat", folder_ / "out.jsonl");
  EXPECT_EQ(content("out.jsonl").substr(0, content("out.jsonl").find('\n')),
            R"({"timestamp":0.0,"sample":{"t_s":0.0,"y_m":0.305,"u_applied_V":1.0,)"
            R"("supply_Pa":10000000.0}})");
  cli::export_log(folder_ / "out.mat", folder_ / "out.mcap");
  EXPECT_THAT(content("out.mcap"), HasSubstr(R"("y_m":0.306)"));
}

TEST_F(FormatsTest, SamplesOfALogAreReadAsAskedAndItsMessagesAreNot) {
  const std::string input = log();
  config::record::ReadOptions reading;
  reading.flip_command = true;
  cli::export_log(input, folder_ / "turned.mat", "sample", "", reading);
  EXPECT_EQ(config::record::read_record(folder_ / "turned.mat").u_V,
            config::record::read_record(input, reading).u_V);
  EXPECT_THROW(cli::export_log(input, folder_ / "turned.json", "", "", reading),
               config::schema::UsageError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "turned.json"));
}

TEST_F(FormatsTest, JsonLinesAreReadByPython) {
  cli::export_log(log(), folder_ / "out.json");
  EXPECT_EQ(run_python("read_json.py " + (folder_ / "out.json").string()).output, "good\n");
}

TEST_F(FormatsTest, McapIsReadByFoxglovesReader) {
  cli::export_log(log(), folder_ / "out.mcap");
  const Result result = run("node " + kReaders + "read_mcap.js " + (folder_ / "out.mcap").string());
  if (result.exit_code == 77 || result.exit_code == 127) {
    GTEST_SKIP() << "@mcap/core is not installed (npm install @mcap/core; NODE_PATH)";
  }
  EXPECT_EQ(result.output,
            "y_m 0.11 at 550000000\n"
            "{\"/sample\":20,\"/estimate/period\":2,\"/alarm/period/b1_low\":2} 24\n");
}

std::uint64_t number(const std::string& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size; i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
  }
  return value;
}

// The parts that any reader needs, as https://mcap.dev/spec lays them out.
TEST_F(FormatsTest, McapHasTheLayoutOfItsSpecification) {
  cli::export_log(log(), folder_ / "out.mcap");
  const std::string file = content("out.mcap");
  const std::string magic("\x89MCAP0\r\n", 8);
  ASSERT_EQ(file.substr(0, 8), magic);
  ASSERT_EQ(file.substr(file.size() - 8), magic);
  std::map<int, int> records;
  std::size_t at = 8;
  std::size_t data_end = 0;
  while (at < file.size() - 8) {
    const int op = file[at];
    ++records[op];
    const std::size_t size = number(file, at + 1, 8);
    if (op == 0x0F) {  // data end
      data_end = at + 9 + size;
      EXPECT_EQ(number(file, at + 9, 4),
                crc32(0, reinterpret_cast<const Bytef*>(file.data()), static_cast<uInt>(at)));
    }
    if (op == 0x06) {  // chunk: two times, size, check sum, no compression
      const std::size_t records_at = at + 9 + 8 + 8 + 8 + 4 + 4 + 8;
      const std::size_t bytes = number(file, records_at - 8, 8);
      EXPECT_EQ(number(file, at + 9 + 16, 8), bytes);
      EXPECT_EQ(
          number(file, at + 9 + 24, 4),
          crc32(0, reinterpret_cast<const Bytef*>(&file[records_at]), static_cast<uInt>(bytes)));
    }
    at += 9 + size;
  }
  ASSERT_EQ(at, file.size() - 8);
  EXPECT_EQ(records[0x01], 1);              // header
  EXPECT_EQ(records[0x06], records[0x08]);  // an index for each chunk
  EXPECT_EQ(records[0x03], 3);              // schemas, once more in the summary
  const std::size_t footer = file.size() - 8 - 20;
  EXPECT_EQ(number(file, footer, 8), data_end);
  EXPECT_EQ(number(file, footer + 16, 4), crc32(0, reinterpret_cast<const Bytef*>(&file[data_end]),
                                                static_cast<uInt>(footer + 16 - data_end)));
}

TEST_F(FormatsTest, SaysWhichFormatsThereAre) {
  const std::string input = log();
  const auto error = [&](const std::string& output, const std::string& channel = "",
                         const std::string& format = "") {
    try {
      cli::export_log(input, output, channel, format);
    } catch (const config::schema::UsageError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error(folder_ / "out.xls"), HasSubstr("allowed: csv, mat, mcap, json"));
  EXPECT_THAT(error(folder_ / "out.csv", "all"), HasSubstr("is no one table"));
  EXPECT_THAT(error(input, "", "mat"), HasSubstr("would overwrite an input"));
  EXPECT_EQ(error(folder_ / "out.xls", "", "csv"), "no error");
  EXPECT_FALSE(fs::exists(folder_ / "out.csv"));
}

}  // namespace
}  // namespace workbench::exchange
