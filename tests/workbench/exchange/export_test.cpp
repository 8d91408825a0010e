#include "workbench/cli/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/pipeline.h"

namespace workbench::exchange {
namespace {

namespace fs = std::filesystem;
using monitor::io::Publisher;
using monitor::io::Recorder;
using testing::EndsWith;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class ExportTest : public testing::Test {
 protected:
  ExportTest() {
    std::string name = (fs::temp_directory_path() / "export-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~ExportTest() override { fs::remove_all(folder_); }

  // The messages that `publish` sends, as the recorder writes them.
  std::string log_of(const std::function<void(Publisher&)>& publish) const {
    Recorder recorder({.folder = folder_ / "log"}, 3, false);
    Publisher publisher({.url = ""}, 3, 0.005, &recorder);
    publish(publisher);
    return folder_ / "log" / "spoolwatch-3-00000.lcmlog";
  }
  std::string csv_of(const std::string& log, const std::string& kind) const {
    cli::export_log(log, folder_ / "out.csv", kind);
    std::ifstream in(folder_ / "out.csv");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string error_of(const std::function<void()>& action, int exit_code) {
    try {
      action();
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), exit_code);
      return error.what();
    }
    return "no error";
  }
  static void samples(Publisher& publisher, int count) {
    for (int tick = 0; tick < count; ++tick) {
      config::signals::Sample sample;
      sample.tick = tick + 100;
      sample.y_m = 0.1 + 1e-3 * tick;
      sample.u_applied_V = 2.5 * tick;
      sample.reference_m = 0.25;
      publisher.sample(sample);
    }
  }

  fs::path folder_;
};

TEST_F(ExportTest, WritesSamplesAsARecordThatReadsBackTheSame) {
  const std::string log = log_of([](Publisher& publisher) { samples(publisher, 20); });
  EXPECT_THAT(csv_of(log, "sample"), testing::StartsWith("t_s,u_V,y_m,reference_m"));
  const auto from_log = config::record::read_record(log);
  const auto from_csv = config::record::read_record(folder_ / "out.csv");
  ASSERT_EQ(from_csv.size(), 20U);
  EXPECT_EQ(from_csv.t_s, from_log.t_s);
  EXPECT_EQ(from_csv.u_V, from_log.u_V);
  EXPECT_EQ(from_csv.y_m, from_log.y_m);
  EXPECT_EQ(from_csv.y_m[10], 0.1 + 1e-3 * 10);
  EXPECT_EQ(from_csv.column("reference_m")->at(3), 0.25);
  EXPECT_DOUBLE_EQ(from_csv.t_s[0], 0.5);
}

TEST_F(ExportTest, WritesOneRowPerEstimatedNumberOnTheTimeOfTheSamples) {
  const std::string log = log_of([](Publisher& publisher) {
    const estimator::fdi::EstimatedValue values[] = {{"a1", -1.0, kNaN, kNaN, kNaN},
                                                     {"b1", 2e-4, 1e-6, 1.9e-4, 2.1e-4}};
    estimator::fdi::EstimateEvent event{};
    event.source = "period";
    event.tick = 400;
    event.valid = false;
    event.reason = "short, \"gap\"";
    event.condition = 12.5;
    event.begin_values = std::begin(values);
    event.end_values = std::end(values);
    publisher.estimate(event, {});
    samples(publisher, 1);
  });
  EXPECT_EQ(csv_of(log, "estimate"),
            "t_s,source,valid,name,value,std_error,low,high,condition,reason\n"
            "2,period,0,a1,-1,,,,12.5,\"short, \"\"gap\"\"\"\n"
            "2,period,0,b1,2e-04,1e-06,0.00019,0.00021,12.5,\"short, \"\"gap\"\"\"\n");
}

TEST_F(ExportTest, WritesOneRowPerAlarmMessage) {
  const std::string log = log_of([](Publisher& publisher) {
    estimator::fdi::Alarm alarm;
    alarm.source = "period";
    alarm.name = "b1_low";
    alarm.quantity = "period.b1";
    alarm.severity = estimator::fdi::Severity::major;
    alarm.active = true;
    alarm.direction = -1;
    alarm.value = 1.5;
    alarm.tick = 9;
    publisher.alarm(alarm, true, {7'000'000, 0});
    publisher.alarm(alarm, false, {8'500'000, 0});
  });
  // Without samples there is no period: the time counts from the first message.
  EXPECT_THAT(csv_of(log, "alarm"),
              EndsWith("\n0,period,b1_low,MAJOR,1,1,period.b1,1.5,,,,-1,,0,,\n"
                       "1.5,period,b1_low,MAJOR,1,0,period.b1,1.5,,,,-1,,0,,\n"));
  // No estimate in a log of ours is a table without rows.
  EXPECT_EQ(csv_of(log, "estimate"),
            "t_s,source,valid,name,value,std_error,low,high,condition,reason\n");
}

TEST_F(ExportTest, RefusesWhatIsNoLogOfOursAndLeavesNoFile) {
  const std::string csv = folder_ / "out.csv";
  const std::string missing = folder_ / "missing";
  EXPECT_THAT(error_of([&] { cli::export_log(missing, csv, "alarm"); }, 65),
              EndsWith("cannot be read: No such file or directory"));
  const std::string text = folder_ / "text.csv";
  std::ofstream(text) << "t_s,u_V,y_m\n0,1,2\n";
  EXPECT_THAT(error_of([&] { cli::export_log(text, csv, "alarm"); }, 65),
              HasSubstr("is no LCM event log: it has samples alone"));
  EXPECT_THAT(error_of([&] { cli::export_log(text, csv, "sample"); }, 65),
              HasSubstr("has fewer than 3 samples"));
  const std::string empty = folder_ / "empty";
  std::ofstream{empty};
  EXPECT_THAT(error_of([&] { cli::export_log(empty, csv, "sample"); }, 65), HasSubstr("is empty"));
  const std::string other = folder_ / "other.log";
  {
    lcm::LogFile log(other, "w");
    char data[] = "0123456789";
    lcm::LogEvent event{0, 1, "OTHER", sizeof data, data};
    log.writeEvent(&event);
  }
  for (const char* kind : {"sample", "estimate", "alarm"}) {
    error_of([&] { cli::export_log(other, csv, kind); }, 65);
  }
  EXPECT_FALSE(fs::exists(csv));
}

TEST_F(ExportTest, NamesTheEventThatIsOfAnotherType) {
  const std::string log = folder_ / "mixed.log";
  {
    lcm::LogFile file(log, "w");
    char data[] = "0123456789";
    lcm::LogEvent event{0, 1, "SPOOLWATCH_ALARM", sizeof data, data};
    file.writeEvent(&event);
  }
  EXPECT_THAT(error_of([&] { cli::export_log(log, folder_ / "out.csv", "alarm"); }, 65),
              HasSubstr("event 0: on SPOOLWATCH_ALARM is of another type"));
}

TEST_F(ExportTest, SaysWhyAFileCannotBeWritten) {
  const std::string log = log_of([](Publisher& publisher) { samples(publisher, 3); });
  EXPECT_THAT(
      error_of([&] { cli::export_log(log, folder_ / "no_folder" / "out.csv", "alarm"); }, 1),
      HasSubstr("does not exist"));
}

}  // namespace
}  // namespace workbench::exchange
