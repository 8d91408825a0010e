// Every kind of source goes on bit for bit after a snapshot, and takes no memory.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/count_allocations.h"
#include "tests/estimator/fdi/plain_values.h"

namespace estimator::fdi {
namespace {

const char* const kEveryKind = R"(
[[estimator]]
id = "e"
method = "sliding"
window_s = 50.0
stride_s = 5.0
[[cusum]]
id = "cusum"
quantity = "e.b1"
block_s = 10.0
mean = 1.0e-3
std_dev = 1.0e-4
false_alarm_time_s = 1000.0
[[glr]]
id = "glr"
quantity = "e.b1"
block_s = 10.0
mean = 1.0e-3
std_dev = 1.0e-4
false_alarm_time_s = 1000.0
parameter = "gain"
[[trend]]
id = "trend"
quantity = "e.b1"
block_s = 10.0
std_dev = 1.0e-4
memory_s = 300.0
high = 2.0e-3
horizon_s = 1.0e9
[[distance]]
id = "distance"
features = ["e.a1", "e.b1"]
block_s = 10.0
false_alarm_time_s = 1000.0
[distance.healthy]
name = "healthy"
blocks = 100
mean = [-1.0, 1.0e-3]
covariance = [1.0e-6, 0.0, 0.0, 1.0e-8]
long_run = [1.0e-3, 1.0e-4]
[[classifier]]
id = "classifier"
features = ["e.b1"]
block_s = 10.0
[[classifier.class]]
name = "healthy"
blocks = 100
mean = [1.0e-3]
covariance = [1.0e-8]
long_run = [1.0e-4]
[[classifier.class]]
name = "gain"
direction = 1
blocks = 100
mean = [1.5e-3]
covariance = [1.0e-8]
long_run = [1.0e-4]
[[voter]]
id = "voter"
channels = ["sample.y_m", "sample.reference_m"]
tolerance = 0.05
[[observer]]
id = "observer"
u = ["sample.u_V"]
y = ["sample.y_m", "sample.reference_m"]
a = [1.0]
b = [1.0e-3]
c = [1.0, 1.0]
output_std = [1.0e-3, 1.0e-3]
process_std = 1.0e-4
bank = true
limit = 3.0
window_s = 20.0
stride_s = 10.0
)";

class Stream {
 public:
  /// The gain rises after a while, a channel leaves for a while, a gap comes.
  config::signals::Sample next() {
    config::signals::Sample s;
    s.tick = tick_;
    s.u_applied_V = std::sin(0.05 * static_cast<double>(tick_)) +
                    0.4 * std::sin(0.31 * static_cast<double>(tick_));
    s.y_m = y_m_ + noise_(random_);
    s.reference_m = y_m_ + noise_(random_) + (tick_ % 900 > 800 ? 0.2 : 0.0);
    if (tick_ % 701 == 700) s.y_m = std::nan("");
    y_m_ += (tick_ % 2000 < 1000 ? 1e-3 : 1.5e-3) * s.u_applied_V;
    tick_ += tick_ % 1203 == 1202 ? 4 : 1;
    return s;
  }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> noise_{0.0, 1e-4};
  std::int64_t tick_ = 0;
  double y_m_ = 0.0;
};

/// All that is reported, as bytes.
class Bytes final : public Events {
 public:
  void on_estimate(const EstimateEvent& event) override {
    ++estimates;
    if (!keeps) return;
    put(static_cast<double>(event.tick));
    text += std::string(event.source) + std::string(event.reason);
    for (const EstimatedValue& v : event) {
      put(v.value);
      put(v.std_error);
    }
  }
  void on_alarm(const Alarm& alarm) override {
    ++alarms;
    if (!keeps) return;
    put(alarm.value);
    put(alarm.confidence);
    text += alarm.source + alarm.name + alarm.parameter + alarm.reason;
    sources += alarm.source + " ";
  }
  std::string text, sources;
  bool keeps = true;
  int estimates = 0;
  int alarms = 0;

 private:
  void put(double number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text.append(bytes, sizeof bytes);
  }
};

TEST(EveryKind, GoesOnBitForBitFromAnyMoment) {
  const PipelineConfig config = fdi_test::read_rules(kEveryKind);
  for (const int at : {0, 57, 805, 1003, 1490, 2777}) {
    Stream stream;
    Pipeline whole(config, 1.0);
    Bytes before;
    for (int i = 0; i < at; ++i) whole.process(stream.next(), before);
    std::vector<std::uint8_t> snapshot;
    StateArchive out = StateArchive::saving(snapshot);
    whole.serialize(out);
    Pipeline restored(config, 1.0);
    StateArchive in = StateArchive::restoring(snapshot);
    restored.serialize(in);
    ASSERT_TRUE(in.complete()) << at;
    Bytes a;
    Bytes b;
    for (int i = at; i < 4000; ++i) {
      const config::signals::Sample sample = stream.next();
      whole.process(sample, a);
      restored.process(sample, b);
    }
    EXPECT_TRUE(a.text == b.text) << "differs after sample " << at;
    for (const char* source : {"cusum", "glr", "distance", "classifier", "voter", "observer"}) {
      EXPECT_NE(a.sources.find(source), std::string::npos) << source << " has told an alarm";
    }
  }
}

TEST(EveryKind, TakesNoMemoryOnceItsAlarmsHaveBeenNamedOnce) {
  if (SPOOLWATCH_COUNTS_MALLOC == 0) GTEST_SKIP() << "the sanitizer owns malloc";
  Pipeline pipeline(fdi_test::read_rules(kEveryKind), 1.0);
  Stream stream;
  Bytes events;
  events.keeps = false;
  for (int i = 0; i < 4500; ++i) pipeline.process(stream.next(), events);
  const long before = allocations;
  const int alarms = events.alarms;
  // No group is named anew in here: a vector of names is the one thing that takes memory.
  for (int i = 0; i < 280; ++i) pipeline.process(stream.next(), events);
  EXPECT_EQ(allocations, before) << events.alarms - alarms << " alarms";
}

TEST(EveryKind, MeansTheSameAfterPrintingAndReading) {
  PipelineConfig config = fdi_test::read_rules(kEveryKind);
  const auto print = [](PipelineConfig& c) {
    return config::schema::print_toml([&](config::schema::Visitor& v) { c.visit(v); });
  };
  const std::string printed = print(config);
  PipelineConfig again;
  config::schema::Document::parse(printed, "printed").read([&](config::schema::Visitor& v) {
    again.visit(v);
  });
  EXPECT_EQ(print(again), printed);
  EXPECT_NO_THROW(Pipeline(again, 1.0));
}

}  // namespace
}  // namespace estimator::fdi
