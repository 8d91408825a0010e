// Pages that watch: each catches up with the whole last minute, in events that fit its queue, and
// the others are not sent it again.
#include <gmock/gmock.h>

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "config/record/record.h"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/serve/live_channel.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;

constexpr int kRate_Hz = 1000;
constexpr int kSeconds = 61;
constexpr double kBegin_s = 1.795e9;

/// Position of sample k: rises by 0.1 mm a second.
double position_m(int k) { return 0.3 + 1e-7 * k; }

template <class Message>
void write(lcm::LogFile& log, const char* channel, const Message& message) {
  std::vector<char> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  lcm::LogEvent event{};
  event.timestamp = message.tick;
  event.channel = channel;
  event.datalen = static_cast<int>(bytes.size());
  event.data = bytes.data();
  log.writeEvent(&event);
}

/// Supply of sample k: falls by 1 Pa a sample.
double supply_Pa(int k) { return 7e6 - k; }

/// Two rods and the supply, but no chambers, beside sample k.
void write_beside(lcm::LogFile& log, int k) {
  spoolwatch::rods_t rods{};
  rods.run_id = 1;
  rods.seq = rods.tick = k;
  rods.count = 2;
  rods.rod = {"glass", "<b>"};
  rods.y_m = {position_m(k), position_m(k) + 1e-3};
  rods.quality = rods.fault = {0, 0};
  write(log, "LIVE_RODS", rods);
  spoolwatch::pressures_t pressures{};
  pressures.run_id = 1;
  pressures.seq = pressures.tick = k;
  pressures.supply_Pa = supply_Pa(k);
  pressures.in_Pa = pressures.out_Pa = std::nan("");
  write(log, "LIVE_PRESSURES", pressures);
}

/// A minute and a second of samples at a kilohertz.
void write_log(const std::string& file, bool with_more = false) {
  lcm::LogFile log(file, "w");
  ASSERT_TRUE(log.good());
  for (int k = 0; k < kSeconds * kRate_Hz; ++k) {
    spoolwatch::sample_t sample{};
    sample.run_id = 1;
    sample.seq = sample.tick = k;
    sample.utc_us = static_cast<std::int64_t>(kBegin_s * 1e6) + k * (1'000'000 / kRate_Hz);
    sample.sample_time_s = 1.0 / kRate_Hz;
    sample.y_m = position_m(k);
    sample.u_applied_V = 1.0;
    sample.u_requested_V = 1.5;
    if (with_more) write_beside(log, k);
    write(log, "LIVE_SAMPLE", sample);
  }
}

struct Sent {
  std::string name;
  std::string json;
};

/// What each page was sent.
class Inboxes {
 public:
  void take(const std::vector<StreamId>& pages, const char* name, const std::string& json) {
    if (std::string(name) == "status") {
      const std::lock_guard lock(mutex_);
      status_ = json;
      return;
    }
    if (std::string(name) == "capture") ++captures;
    {
      const std::lock_guard lock(mutex_);
      for (const StreamId page : pages) sent_[page].push_back({name, json});
    }
    more_.notify_all();
  }
  /// Waits until the page has that many points.
  std::vector<Sent> when_it_has(StreamId page, std::size_t points) {
    std::unique_lock lock(mutex_);
    more_.wait_for(lock, std::chrono::seconds(60), [&] { return points_of(page) >= points; });
    EXPECT_GE(points_of(page), points);
    return sent_[page];
  }

  ordered_json status() {
    const std::lock_guard lock(mutex_);
    return ordered_json::parse(status_, nullptr, false);
  }

  std::atomic<int> captures{0};

 private:
  /// Commas count the numbers of all columns, of which "t" is one.
  std::size_t points_of(StreamId page) {
    std::size_t points = 0;
    for (const Sent& one : sent_[page]) {
      const auto commas = std::count(one.json.begin(), one.json.end(), ',');
      const auto columns = std::count(one.json.begin(), one.json.end(), '[');
      points += static_cast<std::size_t>(commas / columns);
    }
    return points;
  }
  std::mutex mutex_;
  std::condition_variable more_;
  std::map<StreamId, std::vector<Sent>> sent_;
  std::string status_;
};

/// Times of the points in order, s after kBegin_s.
std::vector<double> times_of(const std::vector<Sent>& events) {
  std::vector<double> t_s;
  for (const Sent& one : events) {
    const ordered_json batch = ordered_json::parse(one.json);
    for (const ordered_json& t : batch["t"]) {
      t_s.push_back(batch["t0"].get<double>() + t.get<double>() - kBegin_s);
    }
  }
  return t_s;
}

/// The log played as fast as it can be read.
LiveChannel channel_of(const std::string& log, Inboxes& inboxes) {
  return LiveChannel(
      {"file://" + log + "?mode=r&speed=0", "LIVE"},
      [&](const auto& pages, const char* name, const std::string& json) {
        inboxes.take(pages, name, json);
      },
      [] {});
}

TEST(LiveChannel, EachPageCatchesUpWithTheLastMinuteByItself) {
  const std::string log =
      (std::filesystem::temp_directory_path() / ("live_channel_" + std::to_string(getpid())))
          .string();
  write_log(log);
  Inboxes inboxes;
  LiveChannel channel = channel_of(log, inboxes);
  constexpr std::size_t kAll = kSeconds * kRate_Hz;
  constexpr std::size_t kMinute = 60 * kRate_Hz;
  channel.open(1);
  const std::size_t of_first = inboxes.when_it_has(1, kAll - kRate_Hz).size();
  channel.open(2);
  std::vector<Sent> second = inboxes.when_it_has(2, kMinute - 10);
  for (int i = 0; i < 500 && times_of(second).back() < kSeconds - 1.5 / kRate_Hz; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    second = inboxes.when_it_has(2, kMinute - 10);
  }
  // The default of HttpLimits holds ten of them for a client that is slow.
  constexpr std::size_t kMostBytes = HttpLimits{}.stream_bytes / 8;
  for (const Sent& one : second) {
    EXPECT_EQ(one.name, "history");
    EXPECT_LT(one.json.size(), kMostBytes);
  }
  EXPECT_GT(second.size(), 10U);
  EXPECT_TRUE(ordered_json::parse(second.front().json)["begins"].get<bool>());
  EXPECT_FALSE(ordered_json::parse(second[1].json)["begins"].get<bool>());
  EXPECT_NEAR(ordered_json::parse(second.front().json)["newest"].get<double>() - kBegin_s,
              kSeconds - 1.0 / kRate_Hz, 1e-6);
  const std::vector<double> t_s = times_of(second);
  ASSERT_GE(t_s.size(), kMinute);
  for (std::size_t k = 1; k < t_s.size(); ++k) {
    ASSERT_NEAR(t_s[k] - t_s[k - 1], 1.0 / kRate_Hz, 1e-5) << k;
  }
  EXPECT_NEAR(t_s.back(), kSeconds - 1.0 / kRate_Hz, 1e-5);

  channel.close(2);
  channel.open(3);
  (void)inboxes.when_it_has(3, kMinute - 10);
  const std::vector<Sent> first = inboxes.when_it_has(1, 1);
  EXPECT_LE(first.size(), of_first + 2) << "others opened and closed";
  EXPECT_LE(times_of(first).size(), kAll);
  channel.end();
  std::filesystem::remove(log);
}

TEST(LiveChannel, ATriggerCapturesTheFullRateAsARecord) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("live_capture_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string log = (folder / "log").string();
  write_log(log);
  Inboxes inboxes;
  LiveChannel channel = channel_of(log, inboxes);
  EXPECT_EQ(channel.capture(), nullptr);
  EXPECT_EQ(channel.capture(1), nullptr);
  TriggerSettings settings;
  settings.mode = TriggerSettings::Mode::single;
  settings.level = 303.00005;  // mm, between the samples of 30.000 and 30.001 s
  settings.window_s = 4.0;
  settings.before_ratio = 0.25;
  channel.set_trigger(settings);
  channel.open(1);
  (void)inboxes.when_it_has(1, 60 * kRate_Hz);
  channel.open(2);  // is shown the newest capture too
  (void)inboxes.when_it_has(2, 59 * kRate_Hz);
  // A page that loads itself again begins nothing again.
  channel.close(1);
  channel.close(2);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  channel.open(3);
  (void)inboxes.when_it_has(3, 59 * kRate_Hz);
  const auto capture = channel.capture();
  ASSERT_NE(capture, nullptr);
  EXPECT_EQ(inboxes.captures, 3) << "shown to each page";
  EXPECT_EQ(capture->number, 1U);
  EXPECT_EQ(channel.capture(1), capture);
  EXPECT_EQ(channel.capture(2), nullptr) << "another than the page shows is not saved in its place";
  EXPECT_NEAR(capture->span.at_s - kBegin_s, 30.0005, 1e-5);
  const ordered_json drawn = ordered_json::parse(to_json(*capture));
  EXPECT_NEAR(drawn["from"].get<double>(), -1.0, 1e-9);
  EXPECT_NEAR(drawn["to"].get<double>(), 3.0, 1e-9);
  EXPECT_NEAR(drawn["t"].front().get<double>(), -0.9995, 1e-5);

  const std::string file = (folder / "capture.csv").string();
  config::record::write_csv(record_of(*capture), file);
  const config::record::Record read = config::record::read_record(file);
  ASSERT_EQ(read.size(), 4U * kRate_Hz);
  EXPECT_NEAR(read.t_s.front(), 29.001, 1e-9);
  EXPECT_NEAR(read.sample_time_s, 1.0 / kRate_Hz, 1e-12);
  EXPECT_EQ(read.y_m.front(), position_m(29'001));
  EXPECT_NE(read.column("reference_m"), nullptr);
  channel.end();
  std::filesystem::remove_all(folder);
}

TEST(LiveChannel, TheWorstRegionIsSaidInTimesOfTheSamples) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("live_worst_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string log = (folder / "log").string();
  constexpr double kSwing_rad_per_s = 6.0;
  {
    lcm::LogFile file(log, "w");
    for (int k = 0; k < 40 * 200; ++k) {  // the rod stands still from 35 to 38 s
      const double t_s = k / 200.0;
      const double moved_s = t_s < 35.0 ? t_s : std::max(35.0, t_s - 3.0);
      spoolwatch::sample_t sample{};
      sample.run_id = 1;
      sample.seq = sample.tick = k;
      sample.utc_us = static_cast<std::int64_t>((kBegin_s + t_s) * 1e6);
      sample.sample_time_s = 1.0 / 200.0;
      sample.y_m = 0.3 + 0.05 / kSwing_rad_per_s * (1.0 - std::cos(kSwing_rad_per_s * moved_s));
      sample.u_applied_V = std::sin(kSwing_rad_per_s * t_s);
      write(file, "LIVE_SAMPLE", sample);
    }
  }
  Inboxes inboxes;
  LiveChannel channel = channel_of(log, inboxes);
  channel.watch_model(SPOOLWATCH_SOURCE_DIR "/config/models/velocity_servo.toml");
  channel.open(1);
  ordered_json worst;
  // A report may come before the log is read to its end: the region of that part is another one.
  const auto of_whole_log = [&] {
    return worst.is_object() && !worst["spans"].empty() &&
           worst["spans"].front()[0].get<double>() - kBegin_s > 34.0;
  };
  for (int i = 0; i < 1500 && !of_whole_log(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const ordered_json status = inboxes.status();
    if (status.contains("model") && status["model"].is_object()) worst = status["model"]["worst"];
  }
  ASSERT_TRUE(worst.is_object()) << inboxes.status();
  ASSERT_FALSE(worst["spans"].empty());
  EXPECT_NEAR(worst["spans"].front()[0].get<double>() - kBegin_s, 35.0, 1.0);
  EXPECT_LE(worst["spans"].back()[1].get<double>() - kBegin_s, 40.0);
  channel.end();
  std::filesystem::remove_all(folder);
}

TEST(LiveChannel, PressuresAndRodsAreChannelsThatCanTrigger) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("live_columns_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string log = (folder / "log").string();
  write_log(log, true);
  Inboxes inboxes;
  LiveChannel channel = channel_of(log, inboxes);
  TriggerSettings settings;
  settings.mode = TriggerSettings::Mode::single;
  settings.channel = "supply";
  settings.edge = TriggerSettings::Edge::falling;
  settings.level = 69.699995;  // bar, between the samples of 30.000 and 30.001 s
  settings.window_s = 4.0;
  channel.set_trigger(settings);
  channel.open(1);
  (void)inboxes.when_it_has(1, 60 * kRate_Hz);
  for (int i = 0; i < 500 && inboxes.captures == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  ordered_json status = inboxes.status();
  for (int i = 0; i < 500 && status["channels"].size() < 8; ++i) {  // one a second
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = inboxes.status();
  }
  std::map<std::string, std::string> listed;
  for (const ordered_json& one : status["channels"]) {
    listed[one["key"].get<std::string>()] = one["words"].get<std::string>() + "|" +
                                            one["plot"].get<std::string>() + "|" +
                                            one["unit"].get<std::string>();
  }
  const std::map<std::string, std::string> expected{{"reference", "reference|position|mm"},
                                                    {"y", "measured|position|mm"},
                                                    {"u", "command|command|V"},
                                                    {"u_requested", "requested|command|V"},
                                                    {"error", "measured less model|model error|µm"},
                                                    {"supply", "supply pressure|pressure|bar"},
                                                    {"rod_1", "rod glass|position|mm"},
                                                    {"rod_2", "rod <b>|position|mm"}};
  EXPECT_EQ(listed, expected) << "the chambers have no reading";
  const Sent last = inboxes.when_it_has(1, 1).back();
  const ordered_json batch = ordered_json::parse(last.json);
  EXPECT_EQ(batch["supply"].size(), batch["t"].size());
  EXPECT_FALSE(batch.contains("in"));

  const auto capture = channel.capture();
  ASSERT_NE(capture, nullptr);
  EXPECT_NEAR(capture->span.at_s - kBegin_s, 30.0005, 1e-5);
  const std::string file = (folder / "capture.csv").string();
  config::record::write_csv(record_of(*capture), file);
  const config::record::Record read = config::record::read_record(file);
  const auto* const supply = read.column("supply_pressure_Pa");
  ASSERT_NE(supply, nullptr);
  EXPECT_EQ(supply->front(), supply_Pa(29'001));
  const auto* const rod = read.column("rod_2_m");
  ASSERT_NE(rod, nullptr);
  EXPECT_EQ(rod->front(), position_m(29'001) + 1e-3);
  channel.end();
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace workbench::serve
