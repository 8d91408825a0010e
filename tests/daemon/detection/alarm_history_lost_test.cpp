// The alarm on changes of alarms that a full disk has kept out of the history.
#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/detection/detector.h"
#include "tests/daemon/program/subprocess.h"

namespace monitor::detection {
namespace {

namespace filesystem = std::filesystem;

constexpr double kPeriod_s = 0.005;
constexpr std::size_t kMostWaiting = 10'000;  // lines, by the documentation
constexpr std::size_t kAtOnce = 100;          // the writer's queue is not much longer

/// A band on the position that neither chatters nor is acknowledged.
estimator::fdi::PipelineConfig far_out() {
  estimator::fdi::PipelineConfig config;
  estimator::fdi::BandConfig band;
  band.id = "far_out";
  band.quantity = "sample.y_m";
  band.high = 0.2;
  band.rules.chatter_count = 0;
  band.rules.acknowledge = false;
  config.bands.push_back(band);
  return config;
}

/// A folder with a directory in the way of the history, as a full disk is.
struct FullFolder : program::Folder {
  FullFolder() { filesystem::create_directory(path() / "history.log"); }
};

class AlarmHistoryLost : public testing::Test {
 protected:
  [[nodiscard]] filesystem::path history() const { return folder_.path() / "history.log"; }
  void sample(double y_m) {
    config::signals::Sample sample;
    sample.tick = tick_++;
    sample.y_m = y_m;
    samples_.push(sample);
    clock_.advance_ns(5'000'000);
  }
  /// The band's alarm comes and goes.
  void change(std::size_t times) {
    for (std::size_t i = 1; i <= times; ++i) {
      out_ = !out_;
      sample(out_ ? 0.3 : 0.1);
      if (i % kAtOnce == 0 || i == times) process();
    }
  }
  void rest(int seconds) {
    for (int i = 0; i < seconds; ++i) {
      for (int k = 0; k < 200; ++k) sample(out_ ? 0.3 : 0.1);
      process();
    }
  }
  void process() {
    detector_.poll();
    // the promise outlives the job that keeps it, the last of those that the detector has posted
    const auto done = std::make_shared<std::promise<void>>();
    if (writer_.post([done] { done->set_value(); })) done->get_future().wait();
  }
  [[nodiscard]] const estimator::fdi::Alarm* alarm() const {
    const std::size_t number = pipeline_.alarms().find("alarms.history_lost");
    if (number == estimator::fdi::AlarmBook::kNone) return nullptr;
    return &pipeline_.alarms().alarm(number);
  }

  FullFolder folder_;
  io::BackgroundWriter writer_;
  io::AlarmStore store_{folder_.path(), "rig", writer_};
  rt::VirtualClock clock_;
  rt::SampleQueue samples_;
  rt::LoopStats stats_;
  estimator::fdi::Pipeline pipeline_{far_out(), kPeriod_s};
  io::Publisher publisher_{{"", "TEST"}, 1, kPeriod_s, nullptr};
  Detector detector_{
      {clock_, samples_, stats_, pipeline_, publisher_, nullptr, {nullptr, nullptr, &store_}},
      {"", "", "", "rod", "v", {}, {}, {}, kPeriod_s}};
  std::int64_t tick_ = 0;
  bool out_ = false;
};

TEST_F(AlarmHistoryLost, StandsFromTheFirstLossUntilTheRestIsWritten) {
  change(kMostWaiting - 200);
  rest(2);
  EXPECT_TRUE(alarm() == nullptr || alarm()->times == 0) << "all of it waits";
  change(300);
  rest(2);
  ASSERT_NE(alarm(), nullptr);
  EXPECT_TRUE(alarm()->active);
  EXPECT_EQ(store_.waiting_history(), kMostWaiting);
  rest(120);  // its own coming is no loss
  for (int i = 0; i < 5; ++i) {
    change(1);
    rest(5);
  }
  EXPECT_TRUE(alarm()->active);
  EXPECT_EQ(alarm()->times, 1);
  EXPECT_FALSE(alarm()->chattering);

  filesystem::remove(history());
  rest(60);
  EXPECT_EQ(store_.waiting_history(), 0U);
  EXPECT_FALSE(alarm()->active);
  EXPECT_EQ(alarm()->times, 1);
  std::ifstream in(history());
  std::size_t found = 0;
  for (std::string line; std::getline(in, line);) {
    found += nlohmann::json::parse(line).value("alarm", "") == "alarms.history_lost" ? 1 : 0;
  }
  EXPECT_EQ(found, 2U) << "its coming and its going";
}

/// Where the writer takes no more jobs, nothing waits and each change is lost at once.
TEST_F(AlarmHistoryLost, GoesThoughItsOwnGoingIsLost) {
  filesystem::remove(history());
  change(2);  // writes what has waited: only the writer's queue is full
  std::promise<void> go_on;
  std::promise<void> begun;  // until then the job itself takes a place of the queue
  writer_.post([&begun, held = go_on.get_future().share()] {
    begun.set_value();
    held.wait();
  });
  begun.get_future().wait();
  while (writer_.post([] {})) {
  }
  change(2);
  rest(1);
  ASSERT_NE(alarm(), nullptr);
  EXPECT_TRUE(alarm()->active);
  rest(30);
  EXPECT_FALSE(alarm()->active);
  EXPECT_EQ(alarm()->times, 1);
  go_on.set_value();
}

}  // namespace
}  // namespace monitor::detection
