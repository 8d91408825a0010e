// A pipeline restored from a snapshot goes on exactly as the one that was saved: every bit of every
// estimate and alarm, for each method and pre-processing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {
namespace {

/// All that is reported, as bytes.
class Bytes final : public Events {
 public:
  void on_estimate(const EstimateEvent& event) override {
    put(static_cast<double>(event.tick));
    put(event.valid ? 1.0 : 0.0);
    put(event.condition);
    for (const EstimatedValue& v : event) {
      for (const double number : {v.value, v.std_error}) put(number);
    }
  }
  void on_alarm(const Alarm& alarm) override {
    ++alarms;
    put(static_cast<double>(alarm.tick));
    put(alarm.value);
    put(static_cast<double>(alarm.state()));
    put(alarm.first_up ? 1.0 : 0.0);
    text += alarm.name + alarm.reason;
  }
  std::string text;
  int alarms = 0;

 private:
  void put(double number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text.append(bytes, sizeof bytes);
  }
};

EstimatorConfig estimator(const char* id, const char* method) {
  EstimatorConfig config;
  config.id = id;
  config.structure = "arx211";
  config.method = method;
  config.window_s = 0.35;
  config.stride_s = 0.02;
  return config;
}

PipelineConfig everything() {
  PipelineConfig config;
  config.estimators = {estimator("batch", "batch"),        estimator("detrended", "batch"),
                       estimator("sliding", "sliding"),    estimator("filtered", "sliding"),
                       estimator("increments", "sliding"), estimator("recursive", "recursive"),
                       estimator("warm", "recursive")};
  config.estimators[1].detrend = "linear";
  config.estimators[3].filter = "low";
  config.estimators[3].filter_high_Hz = 20.0;
  config.estimators[3].decimation = 3;
  config.estimators[4].structure = "arx011";
  config.estimators[4].increments = true;
  config.estimators[6].first_batch_s = 0.5;
  for (const EstimatorConfig& each : config.estimators) {
    BandConfig band;
    band.id = each.id + "_b1";
    band.quantity = each.id + ".b1";
    band.low = 0.9e-3;
    band.high = 1.1e-3;
    band.on_delay_s = 0.05;
    band.rules.latch = each.method == "batch";
    band.rules.count = each.method == "sliding" ? 2 : 1;
    config.bands.push_back(band);
  }
  return config;
}

std::vector<config::signals::Sample> samples() {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 2e-6);
  std::vector<config::signals::Sample> all;
  double y_m = 0.0;
  config::signals::Sample s;
  for (std::int64_t tick = 0; tick < 3000; ++tick) {
    const double gain = tick % 500 < 250 ? 1e-3 : 1.3e-3;
    s.u_applied_V = std::sin(0.05 * static_cast<double>(tick)) +
                    0.4 * std::sin(0.31 * static_cast<double>(tick));
    s.tick = tick;
    s.utc_us = 5000 * tick;
    s.y_m = y_m + noise(random);
    y_m += gain * s.u_applied_V;
    s.saturated = tick % 97 == 0;
    s.quality = tick % 201 == 0 ? config::signals::Quality::bad : config::signals::Quality::good;
    if (tick % 611 < 5) continue;  // a gap
    all.push_back(s);
  }
  return all;
}

TEST(Snapshot, GoesOnBitForBitFromAnyMoment) {
  const PipelineConfig config = everything();
  const std::vector<config::signals::Sample> all = samples();
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{33}, std::size_t{777}, std::size_t{1501}, std::size_t{2222}}) {
    Pipeline whole(config, 0.005);
    Bytes before;
    for (std::size_t i = 0; i < at; ++i) whole.process(all[i], before);
    whole.alarms().set_condition("recorder", "disk_full", Severity::minor, true, "full", 1);
    if (at > 1000) whole.alarms().shelve(0, 2.0, "ann");
    std::vector<std::uint8_t> snapshot;
    StateArchive saver = StateArchive::saving(snapshot);
    whole.serialize(saver);

    Pipeline restored(config, 0.005);
    StateArchive loader = StateArchive::restoring(snapshot);
    restored.serialize(loader);
    ASSERT_TRUE(loader.complete()) << at;
    Bytes a;
    Bytes b;
    for (std::size_t i = at; i < all.size(); ++i) {
      whole.process(all[i], a);
      restored.process(all[i], b);
    }
    EXPECT_GT(a.alarms, 2) << "the comparison covers alarms";
    EXPECT_TRUE(a.text == b.text) << "differs after sample " << at;
  }
}

TEST(Snapshot, OfAnotherConfigurationOrCutOffIsRefused) {
  const PipelineConfig config = everything();
  Pipeline one(config, 0.005);
  Bytes events;
  for (const config::signals::Sample& s : samples()) one.process(s, events);
  std::vector<std::uint8_t> snapshot;
  StateArchive saver = StateArchive::saving(snapshot);
  one.serialize(saver);

  PipelineConfig other = config;
  other.estimators[2].window_s = 0.5;
  Pipeline another(other, 0.005);
  StateArchive loader = StateArchive::restoring(snapshot);
  another.serialize(loader);
  EXPECT_FALSE(loader.complete());
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, snapshot.size() - 1}) {
    Pipeline same(config, 0.005);
    StateArchive cut = StateArchive::restoring(std::span(snapshot).first(size));
    same.serialize(cut);
    EXPECT_FALSE(cut.complete()) << size;
  }
}

}  // namespace
}  // namespace estimator::fdi
