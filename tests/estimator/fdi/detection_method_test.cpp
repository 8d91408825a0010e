// Sources other than estimators: kinds handed in by the caller, values that bands and other sources
// read, alarms that a source sets and names itself.
#include "estimator/fdi/detection_method.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "tests/estimator/fdi/watched_integrator.h"

namespace estimator::fdi {
namespace {

using config::schema::Document;
using config::schema::Visitor;
using fdi_test::Integrator;
using fdi_test::kSampleTime_s;
using fdi_test::Recorder;

/// How often its input came fresh, the input's sum, and an alarm of its own while the input is
/// above a limit: named "a" up to twice that limit, one of {a, b} beyond.
struct CounterConfig final : DetectionMethodConfigOf<CounterConfig> {
  std::string quantity;
  double limit = 1e9;
  void visit(Visitor& v) override {
    v.text({"id", "", true}, id);
    v.text({"quantity", "", true}, quantity);
    v.number({"limit"}, limit);
  }
  [[nodiscard]] std::vector<std::string> inputs() const override { return {quantity}; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
};

class CounterMethod final : public DetectionMethod {
 public:
  CounterMethod(const CounterConfig& config, const MethodContext& context)
      : input_(context.inputs.find(config.quantity, "[[counter]] " + config.id)),
        limit_(config.limit) {}
  [[nodiscard]] std::vector<std::string> names() const override { return {"count", "sum"}; }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    Alarm alarm;
    alarm.name = "high";
    return {alarm};
  }
  bool on_gap(std::int64_t /*periods*/) noexcept override { return false; }
  bool push(const config::signals::Sample& /*sample*/, double /*y_m*/) noexcept override {
    if (!input_.fresh()) return false;
    ++count_;
    if (input_.usable()) sum_ += input_.value();
    return true;
  }
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept override {
    values[0].value = count_;
    values[1].value = sum_;
    MethodOutput found;
    found.valid = input_.usable();
    found.reason = found.valid ? "" : input_.why();
    return found;
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override {
    static constexpr std::array<std::string_view, 2> kBoth{"a", "b"};
    static constexpr FaultName kOne{"a", {}, 0.9};
    static constexpr FaultName kGroup{"", kBoth, 0.5};
    AlarmInput input;
    if (!input_.usable() || input_.value() <= limit_) return input;
    input.severity = Severity::major;
    input.direction = 1;
    input.value = input_.value();
    input.reason = "above";
    input.fault = input_.value() > 2.0 * limit_ ? &kGroup : &kOne;
    return input;
  }
  void reset() override { count_ = sum_ = 0.0; }
  void serialize(StateArchive& archive) override {
    archive.value(count_);
    archive.value(sum_);
  }

 private:
  MethodInput input_;
  double limit_;
  double count_ = 0.0;
  double sum_ = 0.0;
};

std::unique_ptr<DetectionMethod> CounterConfig::make(const MethodContext& context) const {
  return std::make_unique<CounterMethod>(*this, context);
}

constexpr std::array<DetectionMethodKind, 1> kKinds{
    detection_method_kind<CounterConfig>("counter", "for tests")};

PipelineConfig read(const std::string& text) {
  PipelineConfig config(kKinds);
  Document::parse("schema_version = 1\n" + text, "test.toml").read([&](Visitor& v) {
    config.visit(v);
  });
  return config;
}

const char* const kEstimator =
    "[[estimator]]\nid = 'e'\nmethod = 'sliding'\nwindow_s = 1.0\n"
    "stride_s = 0.1\n";

std::string counter(const std::string& id, const std::string& quantity, double limit = 1e9) {
  return "[[counter]]\nid = '" + id + "'\nquantity = '" + quantity +
         "'\nlimit = " + std::to_string(limit) + "\n";
}

config::signals::Sample at(std::int64_t tick, double y_m) {
  config::signals::Sample s;
  s.tick = tick;
  s.y_m = y_m;
  return s;
}

class Values final : public Events {
 public:
  void on_estimate(const EstimateEvent& event) override {
    ++events;
    last = event.value("count");
    sum = event.value("sum");
    source = event.source;
    number = event.estimator;
  }
  void on_alarm(const Alarm& alarm) override { alarms.push_back(alarm); }
  std::vector<Alarm> alarms;
  std::string source;
  std::size_t number = 0;
  int events = 0;
  double last = 0.0, sum = 0.0;
};

TEST(DetectionMethod, ReadsTheSampleOrAnEstimatorOrAnotherSourceWhateverTheOrderInTheFile) {
  const PipelineConfig config =
      read(counter("third", "second.sum") + counter("second", "e.b1") + kEstimator);
  EXPECT_EQ(config.method_ids(), (std::vector<std::string>{"e", "third", "second"}));
  Pipeline pipeline(config, kSampleTime_s);
  Integrator plant;
  Recorder seen;
  fdi_test::run(pipeline, plant, 240, seen);
  // Estimates at samples 20, 40, ... 240: 12 of each source, each after what it reads.
  ASSERT_EQ(seen.estimates.size(), 36U);
  EXPECT_EQ(seen.estimates[0].estimator, 0U);
  EXPECT_EQ(seen.estimates[1].estimator, 2U);
  EXPECT_EQ(seen.estimates[2].estimator, 1U);
  EXPECT_FALSE(seen.estimates[1].valid) << "the window is not full";
  EXPECT_TRUE(seen.estimates[35].valid);
}

TEST(DetectionMethod, ItsValuesAreWatchedByBands) {
  Pipeline pipeline(read(counter("c", "sample.y_m") +
                         "[[band]]\nid = 'many'\nquantity = 'c.count'\nhigh = 3.5\n"),
                    kSampleTime_s);
  Values seen;
  for (std::int64_t tick = 0; tick < 3; ++tick) pipeline.process(at(tick, 0.25), seen);
  EXPECT_TRUE(seen.alarms.empty());
  EXPECT_EQ(seen.sum, 0.75);
  pipeline.process(at(3, 0.25), seen);
  ASSERT_EQ(seen.alarms.size(), 1U);
  EXPECT_EQ(seen.alarms[0].source, "c");
  EXPECT_EQ(seen.alarms[0].value, 4.0);
}

TEST(DetectionMethod, NamesTheFaultOfItsOwnAlarmAndTellsWhenTheNameChanges) {
  Pipeline pipeline(read(counter("c", "sample.y_m", 1.0)), kSampleTime_s);
  Values seen;
  std::int64_t tick = 0;
  for (const double y_m : {0.5, 1.5, 1.6, 2.5, 2.6, 0.5}) pipeline.process(at(tick++, y_m), seen);
  ASSERT_EQ(seen.alarms.size(), 3U);
  EXPECT_EQ(seen.alarms[0].name, "high");
  EXPECT_EQ(seen.alarms[0].parameter, "a");
  EXPECT_EQ(seen.alarms[0].confidence, 0.9);
  EXPECT_EQ(seen.alarms[0].tick, 1);
  EXPECT_EQ(seen.alarms[1].parameter, "");
  EXPECT_EQ(seen.alarms[1].ambiguity_group, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(seen.alarms[1].tick, 3);
  EXPECT_EQ(seen.alarms[2].severity, Severity::ok);
}

TEST(DetectionMethod, GoesOnBitForBitAfterASnapshotAndTakesItsNameAlong) {
  const PipelineConfig config = read(counter("c", "sample.y_m", 1.0) + counter("d", "c.sum"));
  Pipeline one(config, kSampleTime_s);
  Values seen;
  for (std::int64_t tick = 0; tick < 7; ++tick) one.process(at(tick, 2.5), seen);
  std::vector<std::uint8_t> bytes;
  StateArchive out = StateArchive::saving(bytes);
  one.serialize(out);
  Pipeline two(config, kSampleTime_s);
  StateArchive in = StateArchive::restoring(bytes);
  two.serialize(in);
  ASSERT_TRUE(in.complete());
  const Alarm& alarm = two.alarms().alarm(two.alarms().find("c.high"));
  EXPECT_EQ(alarm.ambiguity_group, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(alarm.confidence, 0.5);
  Values a;
  Values b;
  one.process(at(7, 2.5), a);
  two.process(at(7, 2.5), b);
  EXPECT_EQ(a.sum, b.sum);
  EXPECT_EQ(b.last, 8.0);
  EXPECT_TRUE(b.alarms.empty()) << "the alarm stands already";
}

TEST(DetectionMethod, GoesOnUnderNewRulesWhenItsSettingsAndThoseOfWhatItReadsAreTheSame) {
  const std::string rest = counter("c", "e.b1") + counter("d", "sample.y_m");
  Pipeline before(read(kEstimator + rest), kSampleTime_s);
  Integrator plant;
  Recorder seen;
  fdi_test::run(before, plant, 300, seen);
  Pipeline same(read(kEstimator + rest), kSampleTime_s);
  EXPECT_EQ(same.inherit(before), (std::vector<bool>{true, true, true}));
  Pipeline other(read(std::string(kEstimator) + "constant = true\n" + rest), kSampleTime_s);
  EXPECT_EQ(other.inherit(before), (std::vector<bool>{false, false, true}));
}

TEST(DetectionMethod, IsRefusedWhenItReadsWhatIsNotThereOrInACircle) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      Pipeline(read(text), kSampleTime_s);
    } catch (const config::schema::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(counter("c", "sample.z")).find("[[counter]] c: a sample has no z"),
            std::string::npos);
  EXPECT_NE(refusal(counter("c", "d.sum")).find("names no estimator or other source"),
            std::string::npos);
  EXPECT_NE(refusal(counter("c", "d.sum") + counter("d", "c.sum")).find("in turn"),
            std::string::npos);
  EXPECT_NE(refusal(counter("c", "c.sum")).find("in turn"), std::string::npos);
  EXPECT_NE(refusal(counter("c", "sample.y_m") + counter("c", "sample.u_V")).find("taken"),
            std::string::npos);
}

TEST(DetectionMethod, MeansTheSameAfterPrintingAndReadingAndInACopy) {
  PipelineConfig config = read(counter("c", "sample.y_m", 2.5));
  PipelineConfig copy = config;
  const auto print = [](PipelineConfig& c) {
    return config::schema::print_toml([&](Visitor& v) { c.visit(v); });
  };
  EXPECT_EQ(print(copy), print(config));
  EXPECT_NE(copy.find_method("c"), config.find_method("c"));
  EXPECT_EQ(config.fingerprint("c"), "quantity = 'sample.y_m' limit = 2.5");
  EXPECT_TRUE(config.owns("[[counter]] c: limit"));
  EXPECT_FALSE(config.owns("[[count]] c: limit"));
}

TEST(Words, ThatDoNotFitEndAfterAWholeOne) {
  const auto cut = [](const std::string& words) {
    std::array<char, 16> text{};
    words.copy(text.data(), text.size() - 1);
    end_after_a_word(text, static_cast<int>(words.size()));
    return std::string(text.data());
  };
  EXPECT_EQ(cut("fifteen letters"), "fifteen letters");
  EXPECT_EQ(cut("sixteen letters?"), "sixteen...");
  EXPECT_EQ(cut("one two three four"), "one two...");
  EXPECT_EQ(cut("a b c d e f g h i"), "a b c d e f...");
  EXPECT_EQ(cut("onewordwithoutanyspace"), "onewordwitho...");
}

}  // namespace
}  // namespace estimator::fdi
