// `spoolwatch record` against a log whose contents are known, and against a publisher in this
// process.
#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "config/record/record.h"
#include "config/signals/sample.h"
#include "daemon/io/publisher.h"
#include "spoolwatch/sample_t.hpp"
#include "tests/workbench/live/healthy_log.h"
#include "tests/workbench/live/subprocess.h"

namespace workbench::live {
namespace {

namespace fs = std::filesystem;
using config::record::read_record;
using config::record::Record;
using testing::HasSubstr;

const std::string kProgram = std::string(SPOOLWATCH_BIN_DIR) + "/spoolwatch";

std::string played(const std::string& log) { return "'file://" + log + "?mode=r&speed=0'"; }

/// The log without some of its samples, as a network loses them.
void copy_without(const std::string& from, const std::string& to,
                  const std::vector<std::int64_t>& ticks) {
  lcm::LogFile in(from, "r");
  lcm::LogFile out(to, "w");
  while (const lcm::LogEvent* event = in.readNextEvent()) {
    spoolwatch::sample_t sample{};
    const bool is_sample =
        event->channel == "SPOOLWATCH_SAMPLE" && sample.decode(event->data, 0, event->datalen) > 0;
    if (is_sample && std::count(ticks.begin(), ticks.end(), sample.tick) > 0) continue;
    lcm::LogEvent copy = *event;
    out.writeEvent(&copy);
  }
}

TEST(Record, HoldsWhatCameAndMarksWhatDidNot) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "12");
  const std::string lossy = folder.path() / "lossy.lcmlog";
  copy_without(log, lossy, {1000, 1001, 1002, 1003, 1004, 2000, 2001});
  const std::string csv = folder.path() / "r.csv";
  const program::Result result =
      program::spoolwatch("record -o " + csv + " --lcm-url " + played(lossy));
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("2 gaps of 7 periods together (7 datagrams lost, 0 samples"));
  const Record wanted = read_record(lossy);
  const Record found = read_record(csv);
  EXPECT_EQ(found.t_s, wanted.t_s);
  EXPECT_EQ(found.u_V, wanted.u_V);
  EXPECT_EQ(found.y_m, wanted.y_m);
  EXPECT_EQ(found.gaps, wanted.gaps);
  ASSERT_EQ(found.gaps.size(), 2U);
  ASSERT_EQ(found.further.size(), wanted.further.size());
  for (std::size_t column = 0; column < wanted.further.size(); ++column) {
    EXPECT_EQ(found.further[column].first, wanted.further[column].first);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const double value = wanted.further[column].second[k];
      const double same = found.further[column].second[k];
      ASSERT_TRUE(same == value || (std::isnan(same) && std::isnan(value))) << k;
    }
  }
  EXPECT_FALSE(fs::exists(csv + ".part"));
}

TEST(Record, GoesThroughAPipeThatStaysOne) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "12");
  const std::string pipe = folder.path() / "pipe";
  const std::string csv = folder.path() / "r.csv";
  const program::Result result = program::shell(
      "mkfifo " + pipe + "; timeout 20 cat " + pipe + " > " + csv + " & sleep 0.1; " + kProgram +
      " record -o " + pipe + " --lcm-url " + played(log) + " && wait $!");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(read_record(csv).y_m, read_record(log).y_m);
}

TEST(Record, EndsAfterItsDurationOfSamples) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "12");
  const std::string csv = folder.path() / "r.csv";
  const program::Result result =
      program::spoolwatch("record --duration 5 -o " + csv + " --lcm-url " + played(log));
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(read_record(csv).size(), 1000U);
  const program::Result short_one =
      program::spoolwatch("record --duration 50 -o " + csv + " --lcm-url " + played(log));
  EXPECT_EQ(short_one.exit_code, 1) << "it is not what was asked for";
}

/// Sends samples until it goes out of scope.
class Sender {
 public:
  explicit Sender(const std::string& url) : publisher_({.url = url}, 3, 0.005, nullptr) {
    thread_ = std::thread([this] {
      for (std::int64_t tick = 0; !stop_; ++tick) {
        config::signals::Sample sample;
        sample.tick = tick;
        sample.y_m = 0.1;
        publisher_.sample(sample);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
  }
  ~Sender() {
    stop_ = true;
    thread_.join();
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

 private:
  std::atomic<bool> stop_{false};
  monitor::io::Publisher publisher_;
  std::thread thread_;
};

bool grows(const std::string& file) {
  for (int i = 0; i < 200; ++i) {
    std::error_code ignored;
    if (fs::exists(file) && fs::file_size(file, ignored) > 4096) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(Record, KeepsWhatThereIsAtCtrlCAndAfterAKill) {
  const program::Folder folder;
  const std::string url =
      "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
  const Sender sender(url);
  const std::string csv = folder.path() / "r.csv";
  {
    Subprocess recording({kProgram, "record", "-o", csv, "--lcm-url", url});
    ASSERT_TRUE(grows(csv + ".part"));
    EXPECT_FALSE(fs::exists(csv)) << "half a record has no name";
    recording.signal(SIGINT);
    EXPECT_EQ(recording.exit_code(), 0);
  }
  EXPECT_GT(read_record(csv).size(), 50U);
  EXPECT_FALSE(fs::exists(csv + ".part"));
  const std::string killed = folder.path() / "k.csv";
  {
    Subprocess recording({kProgram, "record", "-o", killed, "--lcm-url", url});
    ASSERT_TRUE(grows(killed + ".part"));
    recording.signal(SIGKILL);
    (void)recording.exit_code();
  }
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_TRUE(fs::exists(killed + ".part"));
}

}  // namespace
}  // namespace workbench::live
